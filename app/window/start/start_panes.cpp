// start_panes.cpp: rows of two lines, of which the chosen one is highlighted; buttons; dialogs.
#include "app/window/start/start_panes.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace roomradar {

// ---- the lists of sources and maps, and the chosen entry ----

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
    ImGui::TextWrapped("To see first what this recording holds, and what is missing: %s",
                       source.check_command.c_str());
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

// ---- buttons and their keys: one table of actions ----

namespace {

struct ActionButton {
  const char* label;
  const char* key_name;
  int key;
  StartAction action;
};
constexpr std::array<ActionButton, 8> kActions = {{{"Scan", "S", GLFW_KEY_S, StartAction::kScan},
                                                   {"Play", "P", GLFW_KEY_P, StartAction::kPlay},
                                                   {"Scan more", "M", GLFW_KEY_M, StartAction::kScanMore},
                                                   {"Compare", "C", GLFW_KEY_C, StartAction::kCompare},
                                                   {"Export", "E", GLFW_KEY_E, StartAction::kExport},
                                                   {"Rename", "R", GLFW_KEY_R, StartAction::kRename},
                                                   {"Delete", "Del", GLFW_KEY_DELETE, StartAction::kDelete},
                                                   {"Doctor", "D", GLFW_KEY_D, StartAction::kDoctor}}};

}  // namespace

std::optional<StartAction> draw_action_bar(const Area& area, const StartState& state,
                                           const look::Fonts& fonts) {
  look::begin_pane("actions", area, look::kPanel);
  const float right = area.width - ImGui::GetStyle().WindowPadding.x, gap = look::px(6.0F);
  std::optional<StartAction> clicked;
  float x = 0.0F;
  for (const ActionButton& each : kActions) {
    const std::string text = std::string(each.label) + "  " + each.key_name;
    const float wide = ImGui::CalcTextSize(text.c_str()).x + 2.0F * ImGui::GetStyle().FramePadding.x;
    if (x > 0.0F && x + gap + wide <= right) ImGui::SameLine(0.0F, gap);
    const bool is_lit = each.action == first_action(state), enabled = why_not(state, each.action).empty();
    if (look::button(each.label, each.key_name, is_lit && enabled, {0, 0}, enabled)) clicked = each.action;
    x = ImGui::GetItemRectMax().x - area.x;
  }
  ImGui::PushFont(fonts.small);
  ImGui::TextDisabled("\u2191 \u2193 choose   Tab other list   Enter %s   + - text size   Ctrl+Q quit",
                      first_action(state) == StartAction::kPlay ? "Play" : "Scan");
  ImGui::PopFont();
  look::end_pane();
  return clicked;
}

std::optional<StartAction> action_of_key(int key) {
  for (const ActionButton& each : kActions)
    if (key == each.key) return each.action;
  return std::nullopt;
}

StartAction first_action(const StartState& state) {
  return state.active == StartList::kMaps ? StartAction::kPlay : StartAction::kScan;
}

// ---- questions and notices ----

namespace {

struct DialogButton {
  const char* label;
  const char* key;
  DialogAnswer answer;
};

std::vector<DialogButton> buttons_of(DialogKind kind) {
  switch (kind) {
    case DialogKind::kNewMap:
      return {{"Scan", "Enter", DialogAnswer::kYes}, {"Back", "Esc", DialogAnswer::kNo}};
    case DialogKind::kRename:
      return {{"Rename", "Enter", DialogAnswer::kYes}, {"Back", "Esc", DialogAnswer::kNo}};
    case DialogKind::kDelete:
      return {{"Delete", "Enter", DialogAnswer::kYes}, {"Keep", "Esc", DialogAnswer::kNo}};
    case DialogKind::kExport:
      return {{".html", "H", DialogAnswer::kPage},
              {".glb", "G", DialogAnswer::kGlb},
              {".ply", "P", DialogAnswer::kPly},
              {"Back", "Esc", DialogAnswer::kNo}};
    case DialogKind::kCompare:
      return {{"Compare", "Enter", DialogAnswer::kYes}, {"Back", "Esc", DialogAnswer::kNo}};
    default:
      return {{"Close", "Enter", DialogAnswer::kNo}};
  }
}

bool asks_for_name(const StartDialog& dialog) {
  return dialog.kind == DialogKind::kNewMap || dialog.kind == DialogKind::kRename;
}

void draw_name(StartDialog& dialog) {
  if (dialog.is_new) ImGui::SetKeyboardFocusHere();
  dialog.is_new = false;
  ImGui::SetNextItemWidth(-1.0F);
  ImGui::InputText("##name", dialog.name.data(), dialog.name.size(), ImGuiInputTextFlags_AutoSelectAll);
  if (dialog.fault.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, look::kWarn);
  ImGui::TextWrapped("%s", dialog.fault.c_str());
  ImGui::PopStyleColor();
}

void draw_choices(StartDialog& dialog) {
  for (int i = 0; i < static_cast<int>(dialog.choices.size()); ++i) {
    const std::string& text = dialog.choices[static_cast<std::size_t>(i)];
    ImGui::PushID(i);
    if (ImGui::Selectable(look::shortened(text, ImGui::GetContentRegionAvail().x).c_str(),
                          i == dialog.choice))
      dialog.choice = i;
    if (i == dialog.choice) ImGui::SetScrollHereY(0.5F);
    ImGui::PopID();
  }
}

void draw_lines(const StartDialog& dialog) {
  for (const DialogLine& line : dialog.lines) {
    ImGui::PushStyleColor(ImGuiCol_Text, line.colour);
    ImGui::TextWrapped("%s", line.text.c_str());
    ImGui::PopStyleColor();
  }
}

/// Returns the height of the lines and choices in a dialog of this width.
float content_height(const StartDialog& dialog, float wrap) {
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  float height = 0.0F;
  for (const DialogLine& line : dialog.lines)
    height += ImGui::CalcTextSize(line.text.c_str(), nullptr, false, wrap).y + gap;
  height += static_cast<float>(dialog.choices.size()) * (ImGui::GetTextLineHeight() + gap);
  return height;
}

}  // namespace

DialogAnswer draw_dialog(float width, float height, StartDialog& dialog, const look::Fonts& fonts) {
  const float margin = look::px(16.0F), beside = look::px(22.0F),
              line = ImGui::GetTextLineHeightWithSpacing();
  const float wide = std::min(look::px(600.0F), width - 2.0F * margin);
  const float wrap = wide - 2.0F * beside - ImGui::GetStyle().ScrollbarSize;
  const float button = ImGui::GetFrameHeightWithSpacing(), heading = line + look::px(10.0F);
  const float fault =
      dialog.fault.empty() ? 0.0F : ImGui::CalcTextSize(dialog.fault.c_str(), nullptr, false, wrap).y + line;
  const float fixed = heading + button + look::px(38.0F) + (asks_for_name(dialog) ? button + fault : 0.0F);
  const float content =
      std::min(content_height(dialog, wrap) + look::px(4.0F), height - 2.0F * margin - fixed);
  look::begin_cover("cover", width, height);
  ImGui::SetCursorScreenPos({0.5F * (width - wide), 0.5F * (height - fixed - content)});
  ImGui::PushStyleColor(ImGuiCol_ChildBg, look::kRaised);
  ImGui::PushStyleColor(ImGuiCol_FrameBg, look::kGround);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {beside, look::px(16.0F)});
  ImGui::BeginChild("dialog", {wide, fixed + content}, /*border=*/true, ImGuiWindowFlags_NoNav);
  ImGui::PushFont(fonts.large);
  ImGui::TextUnformatted(look::shortened(dialog.heading, wide - 2.0F * beside).c_str());
  ImGui::PopFont();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
  ImGui::BeginChild("content", {0.0F, content}, /*border=*/false, ImGuiWindowFlags_NoNav);
  draw_lines(dialog);
  draw_choices(dialog);
  ImGui::EndChild();
  ImGui::PopStyleVar();
  if (asks_for_name(dialog)) draw_name(dialog);
  DialogAnswer answer = std::exchange(dialog.pressed, DialogAnswer::kNone);
  ImGui::Dummy({0.0F, 0.0F});
  for (const DialogButton& each : buttons_of(dialog.kind)) {
    if (look::button(each.label, each.key,
                     each.answer != DialogAnswer::kNo || dialog.kind == DialogKind::kNotice))
      answer = each.answer;
    ImGui::SameLine();
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor(2);
  ImGui::End();
  return answer;
}

DialogAnswer answer_of_key(int key, StartDialog& dialog) {
  const bool is_enter = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
  if (key == GLFW_KEY_ESCAPE || (is_enter && dialog.kind == DialogKind::kNotice)) return DialogAnswer::kNo;
  if (dialog.kind == DialogKind::kExport) {
    if (key == GLFW_KEY_H || is_enter) return DialogAnswer::kPage;
    if (key == GLFW_KEY_G) return DialogAnswer::kGlb;
    return key == GLFW_KEY_P ? DialogAnswer::kPly : DialogAnswer::kNone;
  }
  const int last = static_cast<int>(dialog.choices.size()) - 1;
  if (key == GLFW_KEY_UP) dialog.choice = std::max(dialog.choice - 1, 0);
  if (key == GLFW_KEY_DOWN) dialog.choice = std::min(dialog.choice + 1, std::max(last, 0));
  return is_enter ? DialogAnswer::kYes : DialogAnswer::kNone;
}

}  // namespace roomradar
