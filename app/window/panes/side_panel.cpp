// side_panel.cpp: draws the panel at the right.
#include "app/window/panes/panes.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include "app/window/panes/annotate.hpp"
#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

void draw_objects(const Snapshot& shown, UiChannel& link, PlaySettings& settings, const look::Fonts& fonts) {
  look::heading("OBJECTS", fonts);
  for (const ShownObject& object : shown.objects) {
    ImGui::PushID(object.name.c_str());
    const bool is_chosen = object.name == shown.chosen;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##choose", is_chosen, 0, {0.0F, look::px(34.0F)})) {
      link.ask(ChooseObject{object.name});
    }
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImU32 dot = !object.in_room     ? look::kLine
                      : object.is_carried ? look::kWarn
                      : object.asleep     ? look::kGood
                                          : look::kAccent;
    draw->AddCircleFilled({at.x + look::px(8.0F), at.y + look::px(17.0F)}, look::px(4.5F), dot);
    draw->AddText({at.x + look::px(20.0F), at.y + look::px(1.0F)}, look::kText, object.name.c_str());
    draw->AddText(fonts.small, fonts.small->FontSize, {at.x + look::px(20.0F), at.y + look::px(18.0F)},
                  look::kDim, what_it_does(object).c_str());
    ImGui::PopID();
  }
  // The scrollbar of a low window leaves less width.
  const float half = 0.5F * (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x);
  if (look::button("Remove", "Del", false, {half, 0.0F}, !shown.objects.empty())) link.ask(RemoveChosen{});
  ImGui::SameLine();
  if (look::button("Reset", "R", false, {half, 0.0F}, !shown.objects.empty())) link.ask(ResetObjects{});
  ImGui::SetNextItemWidth(half);
  const auto short_name = [](const std::string& mesh) { return mesh.substr(mesh.find_last_of('/') + 1); };
  if (ImGui::BeginCombo("##mesh", short_name(settings.meshes[settings.mesh].mesh).c_str())) {
    for (std::size_t i = 0; i < settings.meshes.size(); ++i) {  // by index, as two files may have the same
                                                                // name
      ImGui::PushID(static_cast<int>(i));
      if (ImGui::Selectable("##file", i == settings.mesh)) settings.mesh = i;
      ImGui::PopID();
      ImGui::SameLine(0.0F, 0.0F);
      ImGui::TextUnformatted(short_name(settings.meshes[i].mesh).c_str());
    }
    ImGui::EndCombo();
  }
  ImGui::SameLine();
  if (look::button("Add", "A", false, {half, 0.0F})) link.ask(new_object_command(settings));
  ImGui::PushItemWidth(-1.0F);
  ImGui::SliderFloat("##size", &settings.new_size_m, 0.0F, 0.6F,
                     settings.new_size_m < 0.001F ? "new: original size" : "new: %.2f m long",
                     ImGuiSliderFlags_AlwaysClamp);  // clamps typed numbers, too
  ImGui::SliderFloat("##height", &settings.drop_height_m, 0.0F, 1.0F, "drop from %.2f m",
                     ImGuiSliderFlags_AlwaysClamp);
  ImGui::SliderFloat("##speed", &settings.throw_speed_mps, 0.5F, 10.0F, "throw at %.1f m/s",
                     ImGuiSliderFlags_AlwaysClamp);
  ImGui::PopItemWidth();
}

/// Draws sliders for the chosen object's mass, friction and restitution.
void draw_material(const Snapshot& shown, UiChannel& link, PlaySettings& settings, const look::Fonts& fonts) {
  const auto chosen = std::find_if(shown.objects.begin(), shown.objects.end(),
                                   [&](const ShownObject& object) { return object.name == shown.chosen; });
  if (chosen == shown.objects.end()) return;
  look::heading("MATERIAL", fonts);
  if (!ImGui::IsAnyItemActive()) {
    settings.mass_kg = static_cast<float>(chosen->mass_kg);
    settings.friction = static_cast<float>(chosen->on_room.friction);
    settings.restitution = static_cast<float>(chosen->on_room.restitution);
  }
  struct Scale {
    float least, most;
    const char* format;
    ImGuiSliderFlags flags = 0;
  };
  const auto slider = [&](const char* id, float& value, const Scale& scale,
                          std::optional<double> BodyMaterial::*field) {
    ImGui::SliderFloat(id, &value, scale.least, scale.most, scale.format,
                       scale.flags | ImGuiSliderFlags_AlwaysClamp);
    if (!ImGui::IsItemDeactivatedAfterEdit()) return;
    BodyMaterial change;
    change.*field = static_cast<double>(value);
    link.ask(material_command(chosen->name, change));
  };
  ImGui::PushItemWidth(-1.0F);
  slider("##mass", settings.mass_kg, {0.001F, 1000.0F, "weighs %.3g kg", ImGuiSliderFlags_Logarithmic},
         &BodyMaterial::mass_kg);
  slider("##friction", settings.friction, {0.0F, 2.0F, "friction %.2f"}, &BodyMaterial::friction);
  slider("##restitution", settings.restitution, {0.0F, 1.0F, "restitution %.2f"}, &BodyMaterial::restitution);
  ImGui::PopItemWidth();
}

void draw_policies(const Snapshot& shown, UiChannel& link, PlaySettings& settings, const look::Fonts& fonts) {
  constexpr std::array<SurfacePolicy, 4> kPolicies = {SurfacePolicy::kMap, SurfacePolicy::kBorder,
                                                      SurfacePolicy::kSkirt, SurfacePolicy::kHoles};
  look::heading("WHAT CAN BE TOUCHED", fonts);
  constexpr std::array<const char*, 4> kWords = {"map", "border", "skirt", "holes"};
  const auto lit = std::find(kPolicies.begin(), kPolicies.end(), shown.surfaces) - kPolicies.begin();
  const int surfaces = look::segments("surfaces", kWords.data(), 4, static_cast<int>(lit));
  if (surfaces >= 0) link.ask(surfaces_command(kPolicies[static_cast<std::size_t>(surfaces)]));

  look::heading("UNKNOWN SPACE", fonts);
  constexpr std::array<const char*, 2> kUnknown = {"free", "solid"};
  const int unknown = look::segments("unknown", kUnknown.data(), 2, shown.unknown_is_solid ? 1 : 0);
  if (unknown >= 0) link.ask(unknown_command(unknown == 1));

  look::heading("RADAR", fonts);
  constexpr std::array<const char*, 3> kModes = {"exact", "sampled", "passes"};
  RadarConfig radar = shown.radar;
  const auto lit_mode = std::find(kRadarModes.begin(), kRadarModes.end(), radar.mode) - kRadarModes.begin();
  const int mode = look::segments("mode", kModes.data(), 3, static_cast<int>(lit_mode));
  if (mode >= 0) {
    radar.mode = kRadarModes[static_cast<std::size_t>(mode)];
    link.ask(radar_command(radar));
  }
  if (!ImGui::IsAnyItemActive()) settings.radar_px = radar.resolution_px;
  ImGui::SetNextItemWidth(-1.0F);
  ImGui::SliderInt("##px", &settings.radar_px, 8, 256, "%d pixels", ImGuiSliderFlags_AlwaysClamp);
  if (ImGui::IsItemDeactivatedAfterEdit()) {
    radar.resolution_px = settings.radar_px;
    link.ask(radar_command(radar));
  }
}

void draw_frame_facts(const Snapshot& shown, const look::Fonts& fonts) {
  look::heading("THIS FRAME", fonts);
  const FrameResult& result = shown.result;
  const double moved = result.foreground.valid > 0 ? 100.0 * static_cast<double>(result.foreground.moved) /
                                                         static_cast<double>(result.foreground.valid)
                                                   : 0.0;
  ImGui::PushFont(fonts.small);
  const auto row = [](const char* name, const char* format, auto... values) {
    std::array<char, 64> text{};
    format_classic(text.data(), text.size(), format, values...);
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(look::px(130.0F));
    ImGui::TextUnformatted(text.data());
  };
  row("dynamic pixels", "%.1f %%", moved);
  row("dynamic triangles", "%zu + %zu behind", result.dynamic_triangles, result.inferred_triangles);
  row("room triangles", "%zu drawn", result.static_triangles_drawn);
  row("contacts", "%d", result.contacts);
  if (!shown.given_up.empty()) ImGui::TextWrapped("to keep the budget: %s", shown.given_up.c_str());
  ImGui::PopFont();
}

}  // namespace

UserCommand new_object_command(const PlaySettings& settings) {
  AddNew add{settings.meshes[settings.mesh]};
  if (settings.new_size_m >= 0.001F) add.source.size_m = static_cast<double>(settings.new_size_m);
  return add;
}

UserCommand surfaces_command(SurfacePolicy surfaces) { return SetSurfaces{surfaces}; }

UserCommand unknown_command(bool is_solid) { return SetUnknown{is_solid}; }

UserCommand radar_command(const RadarConfig& radar) { return SetRadar{radar}; }

UserCommand camera_command(CameraPlay camera) { return PlayCamera{camera}; }

UserCommand material_command(const std::string& object, const BodyMaterial& change) {
  return ChangeMaterial{object, change};
}

void draw_side_panel(const Area& area, const Snapshot& shown, UiChannel& link, PlaySettings& settings,
                     const look::Fonts& fonts) {
  look::begin_pane("side", area, look::kPanel, /*scrolls=*/true);
  draw_objects(shown, link, settings, fonts);
  draw_material(shown, link, settings, fonts);
  draw_policies(shown, link, settings, fonts);
  draw_frame_facts(shown, fonts);
  look::end_pane();
}

}  // namespace roomradar
