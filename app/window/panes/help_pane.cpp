// help_pane.cpp: draws the list of keys over a dimmed window.
#include "app/window/panes/panes.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>

namespace roomradar {
namespace {

constexpr std::array<std::array<const char*, 2>, 23> kHelp = {
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
     {"X", "radar exact, sampled, passes"},
     {"V", "camera, models, both"},
     {"C", "models: look at the chosen object"},
     {"M", "scan more of the room, then play on in it"},
     {"Ctrl + C", "copy the position under the mouse, for a script"},
     {"Esc, a click", "close this; Ctrl + Q quits"}}};

}  // namespace

bool draw_help(float width, float height, const look::Fonts& fonts) {
  const float row = look::px(23.0F), margin = look::px(16.0F);
  const float wide = std::min(look::px(540.0F), width - 2.0F * margin);
  const float tall =
      std::min(row * static_cast<float>(kHelp.size()) + look::px(72.0F), height - 2.0F * margin);
  look::begin_cover("help", width, height);
  ImGui::SetCursorScreenPos({0.5F * (width - wide), 0.5F * (height - tall)});
  ImGui::PushStyleColor(ImGuiCol_ChildBg, look::kRaised);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {look::px(24.0F), look::px(16.0F)});
  ImGui::BeginChild("keys", {wide, tall}, /*border=*/true,
                    ImGuiWindowFlags_NoNav);  // scrolls if it is too low
  ImGui::PushFont(fonts.large);
  ImGui::TextUnformatted("Mouse and keys");
  ImGui::PopFont();
  for (const auto& [keys, what] : kHelp) {
    ImGui::PushStyleColor(ImGuiCol_Text, look::kAccent);
    ImGui::TextUnformatted(keys);
    ImGui::PopStyleColor();
    ImGui::SameLine(std::min(look::px(210.0F), 0.42F * wide));
    ImGui::TextWrapped("%s", what);
  }
  const bool is_on_scrollbar =
      ImGui::GetScrollMaxY() > 0.0F &&
      ImGui::GetMousePos().x > 0.5F * (width + wide) - ImGui::GetStyle().ScrollbarSize - look::px(4.0F);
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::PopStyleColor();
  ImGui::End();
  return ImGui::IsMouseClicked(ImGuiMouseButton_Left) && !is_on_scrollbar;
}

}  // namespace roomradar
