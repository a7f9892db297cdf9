// start_dialog.cpp: draws the dialogs and interprets their keys.
#include "app/window/start/start_panes.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <utility>

namespace roomradar {
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
