// start_lists.cpp: rows of two lines; the chosen row of the active list is highlighted.
#include "app/window/start/start_panes.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace roomradar {
namespace {

struct Row {
  std::string name, detail;
  std::string more;                    ///< added to `detail` if it fits
  const GlTexture* picture = nullptr;  ///< null: none
  bool has_fault = false;
};

struct RowState {
  bool is_chosen = false, is_active = false, has_picture_column = false;
};

float row_height() { return std::floor(look::px(40.0F)); }
float row_gap() { return std::floor(look::px(3.0F)); }

/// Draws a row at the cursor. Returns true if it was clicked.
bool draw_row(int id, const Row& row, const RowState& state, const look::Fonts& fonts) {
  ImGui::PushID(id);
  const float height = row_height(), width = ImGui::GetContentRegionAvail().x;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool clicked = ImGui::InvisibleButton("row", {width, height});
  const ImVec2 end{at.x + width, at.y + height};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (state.is_chosen)
    list.AddRectFilled(at, end, state.is_active ? IM_COL32(64, 196, 172, 60) : look::kRaised, look::px(5.0F));
  if (state.is_chosen && state.is_active) list.AddRect(at, end, look::kAccent, look::px(5.0F));
  if (ImGui::IsItemHovered() && !state.is_chosen) list.AddRect(at, end, look::kLine, look::px(5.0F));
  float x = at.x + look::px(10.0F);
  if (state.has_picture_column) {
    const Area box{at.x + look::px(6.0F), at.y + look::px(4.0F), look::px(50.0F), height - look::px(8.0F)};
    if (row.picture != nullptr && row.picture->width() > 0) {
      const Area image = fitted(box, row.picture->width(), row.picture->height());
      list.AddImage(row.picture->id(), {image.x, image.y}, {image.x + image.width, image.y + image.height});
    }
    x = box.x + box.width + look::px(8.0F);
  }
  const float wide = end.x - x - look::px(8.0F);
  list.AddText({x, at.y + look::px(4.0F)}, row.has_fault ? look::kDim : look::kText,
               look::shortened(row.name, wide).c_str());
  ImGui::PushFont(fonts.small);
  const std::string whole = row.detail + row.more;
  const bool fits = ImGui::CalcTextSize(whole.c_str()).x <= wide;
  list.AddText({x, at.y + look::px(22.0F)}, row.has_fault ? look::kWarn : look::kDim,
               fits ? whole.c_str() : look::shortened(row.detail, wide).c_str());
  ImGui::PopFont();
  ImGui::PopID();
  return clicked;
}

/// Scrolls by whole rows, so that none is cut.
/// @param row  row to scroll into view; < 0: none
void scroll_rows(float height, int row) {
  const float pitch = row_height() + row_gap();
  float first = std::round(ImGui::GetScrollY() / pitch);
  const float shown = std::max(std::round(height / pitch), 1.0F);
  if (row >= 0) first = std::clamp(first, static_cast<float>(row) - shown + 1.0F, static_cast<float>(row));
  if (first * pitch != ImGui::GetScrollY()) ImGui::SetScrollY(first * pitch);
}

/// Begins a list with its heading; its rows scroll.
/// @param row  row to scroll into view; < 0: none
void begin_list(const char* name, const char* heading, const Area& area, bool is_active, int row,
                const look::Fonts& fonts) {
  look::begin_pane(name, area, look::kGround);
  ImGui::PushFont(fonts.small);
  ImGui::PushStyleColor(ImGuiCol_Text, is_active ? look::kAccent : look::kDim);
  ImGui::TextUnformatted(heading);
  ImGui::PopStyleColor();
  ImGui::PopFont();
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0.0F, row_gap()});
  ImGui::PushStyleColor(ImGuiCol_ScrollbarBg, IM_COL32(0, 0, 0, 0));
  const float pitch = row_height() + row_gap();
  const float height =
      std::max(std::floor((ImGui::GetContentRegionAvail().y + row_gap()) / pitch), 1.0F) * pitch;
  ImGui::BeginChild("rows", {0.0F, height}, /*border=*/false, ImGuiWindowFlags_NoNav);
  scroll_rows(height, row);
}

void end_list() {
  ImGui::EndChild();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  look::end_pane();
}

std::string name_of(const MapEntry& map) {
  const std::string path = map.folder.lexically_normal().string();
  return path.starts_with("maps/") ? path.substr(5) : path;
}

Row row_of(const MapEntry& map, const ExaminedMap* examined) {
  Row row;
  row.name = name_of(map);
  row.picture = examined != nullptr ? &examined->picture : nullptr;
  row.has_fault = !map.fault.empty() || (examined != nullptr && !examined->details.fault.empty());
  if (row.has_fault) {
    row.detail = map.is_saved ? "damaged" : "scan interrupted";
    return row;
  }
  for (const auto& [name, value] : facts_of(map, nullptr)) {
    if (name == "saved") row.detail = value;
    if (name == "room") row.more = ", " + value;
  }
  return row;
}

void draw_facts(const std::vector<std::pair<std::string, std::string>>& facts) {
  for (const auto& [name, value] : facts) {
    ImGui::TextDisabled("%s", name.c_str());
    ImGui::SameLine(look::px(86.0F));
    ImGui::TextWrapped("%s", value.c_str());
  }
}

void draw_fault(const std::string& fault) {
  ImGui::PushStyleColor(ImGuiCol_Text, look::kWarn);
  ImGui::TextWrapped("%s", fault.c_str());
  ImGui::PopStyleColor();
}

void draw_title(const std::string& title, const look::Fonts& fonts) {
  ImGui::PushFont(fonts.large);
  ImGui::TextWrapped("%s", title.c_str());
  ImGui::PopFont();
}

void draw_source_detail(const SourceEntry& source, const look::Fonts& fonts) {
  draw_title(source.name, fonts);
  ImGui::TextWrapped("%s", source.detail.c_str());
  if (!source.fault.empty()) return draw_fault(source.fault);
  ImGui::Spacing();
  ImGui::TextWrapped("%s", source.source.c_str());
  ImGui::Spacing();
  ImGui::TextWrapped(
      "Scan (S) makes a map of this room. Play (P) runs augmented reality with this camera in the map "
      "that is chosen below.");
  ImGui::Spacing();
  if (!source.check_command.empty())
    ImGui::TextWrapped("To see first what this recording holds, and what is missing: %s", source.check_command.c_str());
  if (source.kind == SourceKind::kKinect)
    ImGui::TextWrapped(
        "To scan well: walk slowly, 0.5 to 4 m from the surfaces, look at things from several sides, and "
        "return "
        "to the start.");
}

void draw_map_detail(const Area& area, const MapEntry& map, const ExaminedMap* examined,
                     const look::Fonts& fonts) {
  const bool has_picture = examined != nullptr && examined->picture.width() > 0;
  if (has_picture) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    const float height = std::max(area.height - look::px(225.0F), 0.3F * area.height);
    const Area image =
        fitted({at.x, at.y, width, height}, examined->picture.width(), examined->picture.height());
    ImGui::GetWindowDrawList()->AddImage(examined->picture.id(), {image.x, image.y},
                                         {image.x + image.width, image.y + image.height});
    ImGui::Dummy({width, height});
  }
  draw_title(map.folder.lexically_normal().string(), fonts);
  draw_facts(facts_of(map, examined != nullptr ? &examined->details : nullptr));
  if (!map.fault.empty()) draw_fault(map.fault);
  if (examined != nullptr && !examined->details.fault.empty()) draw_fault(examined->details.fault);
}

}  // namespace

void draw_sources(const Area& area, StartState& state, const look::Fonts& fonts, bool scrolls_to_choice) {
  const bool is_active = state.active == StartList::kSources;
  begin_list("sources", "SOURCES", area, is_active, scrolls_to_choice ? static_cast<int>(state.source) : -1,
             fonts);
  for (std::size_t i = 0; i < state.sources.size(); ++i) {
    const SourceEntry& source = state.sources[i];
    const bool is_chosen = i == state.source;
    const Row row{source.name, source.detail, {}, nullptr, !source.fault.empty()};
    if (!draw_row(static_cast<int>(i), row, {is_chosen, is_active, false}, fonts)) continue;
    state.source = i;
    state.active = StartList::kSources;
  }
  end_list();
}

void draw_maps(const Area& area, StartState& state, const ExaminedMaps& examined, const look::Fonts& fonts,
               bool scrolls_to_choice) {
  const bool is_active = state.active == StartList::kMaps;
  begin_list("maps", "MAPS", area, is_active, scrolls_to_choice ? static_cast<int>(state.map) : -1, fonts);
  if (state.maps.empty()) ImGui::TextWrapped("None so far. Choose a source and scan it (S).");
  for (std::size_t i = 0; i < state.maps.size(); ++i) {
    const MapEntry& map = state.maps[i];
    const bool is_chosen = i == state.map;
    const Row row = row_of(map, examined.find(map));
    if (!draw_row(static_cast<int>(i), row, {is_chosen, is_active, true}, fonts)) continue;
    state.map = i;
    state.active = StartList::kMaps;
  }
  end_list();
}

void draw_detail(const Area& area, const StartState& state, const ExaminedMaps& examined,
                 const look::Fonts& fonts) {
  look::begin_pane("detail", area, look::kPanel, /*scrolls=*/true);
  const MapEntry* map = chosen_map(state);
  const SourceEntry* source = chosen_source(state);
  if (state.active == StartList::kMaps && map != nullptr)
    draw_map_detail(area, *map, examined.find(*map), fonts);
  else if (state.active == StartList::kSources && source != nullptr)
    draw_source_detail(*source, fonts);
  look::end_pane();
}

}  // namespace roomradar
