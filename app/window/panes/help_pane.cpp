// help_pane.cpp: draws the list of keys over a dimmed window.
#include "app/window/panes/help_pane.hpp"

#include <imgui.h>

#include <array>

namespace roomradar {
namespace {

constexpr std::array<std::array<const char*, 2>, 21> kHelp = {
    {{"click on a surface", "drop the chosen object there"},
     {"Shift + click", "place it there"},
     {"drag an object", "carry it; let go in motion: throw it"},
     {"wheel while dragging", "nearer, farther"},
     {"right drag", "turn it"},
     {"D  P  T", "drop, place, throw at the mouse"},
     {"Tab", "choose the next object"},
     {"A  Del  R", "add one, remove it, reset all"},
     {"a mesh file dropped here", "add its object"},
     {"Space", "pause"},
     {".", "one more frame"},
     {"F", "hold the camera; objects keep moving"},
     {"Home", "back to the first frame"},
     {"L", "loop, or stay at the end"},
     {"+  -", "speed"},
     {"S", "next surface policy"},
     {"U", "unknown space free, solid"},
     {"X", "radar exact, sampled"},
     {"V", "camera, models, both"},
     {"C", "models: look at the chosen object"},
     {"Esc, a click", "close this; Ctrl + Q quits"}}};

}  // namespace

bool draw_help(float width, float height, const look::Fonts& fonts) {
  const float row = look::px(23.0F), wide = look::px(520.0F);
  const float tall = row * static_cast<float>(kHelp.size()) + look::px(62.0F);
  ImDrawList* draw = ImGui::GetForegroundDrawList();
  draw->AddRectFilled({0.0F, 0.0F}, {width, height}, IM_COL32(8, 10, 13, 150));
  const float left = 0.5F * (width - wide), top = 0.5F * (height - tall);
  // A transparent window over all panes, so a click reaches nothing else.
  ImGui::SetNextWindowPos({0.0F, 0.0F});
  ImGui::SetNextWindowSize({width, height});
  ImGui::Begin("help", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_NoBackground);
  ImGui::SetCursorScreenPos({0.0F, 0.0F});
  const bool is_clicked = ImGui::InvisibleButton("close", {width, height});
  ImGui::End();
  draw->AddRectFilled({left, top}, {left + wide, top + tall}, look::kRaised, look::px(10.0F));
  draw->AddText(fonts.large, fonts.large->FontSize, {left + look::px(24.0F), top + look::px(18.0F)},
                look::kText, "Mouse and keys");
  float y = top + look::px(50.0F);
  for (const auto& [keys, what] : kHelp) {
    draw->AddText({left + look::px(24.0F), y}, look::kAccent, keys);
    draw->AddText({left + look::px(210.0F), y}, look::kText, what);
    y += row;
  }
  return is_clicked;
}

}  // namespace roomradar
