// run_state.cpp: draws the state as a coloured word, and the frame time as a bar.
#include "app/window/panes/panes.hpp"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

constexpr double kStall_s = 1.0;  // time without a new frame after which the bar says so

}  // namespace

void draw_run_state(const Area& area, bool has_two_rows, const Snapshot& shown, const UiChannel& link,
                    double silent_s) {
  if (!has_two_rows) {
    ImGui::SameLine();
    ImGui::SetCursorPosX(area.width - look::px(338.0F));
  }
  ImGui::AlignTextToFramePadding();
  const FrameResult& result = shown.result;
  if (link.is_over())
    look::pill(look::kDim, "the run is over");
  else if (shown.run_frame < 0)
    look::pill(look::kDim, "loading");
  else if (link.is_paused())
    look::pill(look::kWarn, "paused");
  else if (silent_s > kStall_s)
    look::pill(look::kBad, "no frame for " + std::to_string(static_cast<int>(silent_s)) + " s");
  else if (result.status == FrameStatus::kUncertain)
    look::pill(look::kWarn, "uncertain");
  else if (result.status != FrameStatus::kDone)
    look::pill(look::kBad, "not located");
  else if (shown.is_repeating)
    look::pill(look::kGood, shown.is_held ? "camera held" : "at the end");
  else
    look::pill(look::kGood, result.tracking == TrackStatus::kDegenerate ? "partly tracked" : "tracked");
}

void draw_frame_time(const Area& area, bool has_two_rows, const TimingPane& timing, double frames_per_s,
                     double speed, const look::Fonts& fonts) {
  ImDrawList* draw = ImGui::GetWindowDrawList();
  const float frame_ms = timing.frame_ms();
  std::array<char, 48> text{};
  format_classic(text.data(), text.size(), "%.1f ms   %.0f fps", static_cast<double>(frame_ms), frames_per_s);
  if (speed != 1.0)
    format_classic(text.data(), text.size(), "%.1f ms   %.0f fps   x%g", static_cast<double>(frame_ms),
                   frames_per_s, speed);
  const float left = area.width - look::px(182.0F), top = area.y + look::px(has_two_rows ? 50.0F : 10.0F),
              width = look::px(168.0F);
  draw->AddText(fonts.small, fonts.small->FontSize, {left, top}, look::kText, text.data());
  // Frame time and goal as fractions of the budget.
  const float bar_y = top + look::px(19.0F), bar_height = look::px(6.0F), rounding = look::px(3.0F);
  const float budget_ms = static_cast<float>(timing.budget_ms());
  const float goal_ms = static_cast<float>(timing.goal_ms());
  const float part = std::min(frame_ms / budget_ms, 1.0F);
  const ImU32 colour = frame_ms <= goal_ms ? look::kGood : frame_ms <= budget_ms ? look::kWarn : look::kBad;
  draw->AddRectFilled({left, bar_y}, {left + width, bar_y + bar_height}, look::kRaised, rounding);
  draw->AddRectFilled({left, bar_y}, {left + std::max(part * width, bar_height), bar_y + bar_height}, colour,
                      rounding);
  const float goal_x = left + goal_ms / budget_ms * width;
  draw->AddLine({goal_x, bar_y - look::px(2.0F)}, {goal_x, bar_y + look::px(8.0F)}, look::kDim,
                look::px(1.0F));
}

}  // namespace roomradar
