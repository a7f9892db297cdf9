// action_bar.cpp: one table of actions for buttons and keys.
#include "app/window/start/start_panes.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <array>
#include <string>

namespace roomradar {
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

}  // namespace roomradar
