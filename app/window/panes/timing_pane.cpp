// timing_pane.cpp: draws a column per frame, with a colour per stage.
#include "app/window/panes/panes.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "mapping/types/system/classic_locale.hpp"

namespace roomradar {
namespace {

constexpr std::array<ImU32, TimingPane::kStages.size()> kColours = {
    IM_COL32(86, 156, 214, 255),  IM_COL32(64, 196, 172, 255),  IM_COL32(150, 206, 96, 255),
    IM_COL32(214, 214, 110, 255), IM_COL32(240, 178, 74, 255),  IM_COL32(232, 122, 82, 255),
    IM_COL32(235, 92, 130, 255),  IM_COL32(204, 152, 236, 255), IM_COL32(176, 124, 222, 255),
    IM_COL32(98, 108, 124, 255)};

float median(std::vector<float>& values) {
  if (values.empty()) return 0.0F;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void TimingPane::add(const Snapshot& shown) {
  Times times;
  const auto ms_of = [&](std::string_view stage) {
    for (const auto& [name, ms] : shown.stages_ms)
      if (name == stage) return ms;
    return 0.0F;
  };
  times.whole_ms = ms_of("frame");
  times.read_ms = ms_of("read");
  float sum_ms = 0.0F;
  for (std::size_t i = 0; i + 1 < kStages.size(); ++i) {
    times.stages_ms[i] = ms_of(kStages[i]);
    if (std::string_view(kStages[i]) == "physics") times.stages_ms[i] -= ms_of("radar");  // a part of physics
    times.stages_ms[i] = std::max(times.stages_ms[i], 0.0F);
    sum_ms += times.stages_ms[i];
  }
  times.stages_ms.back() = std::max(times.whole_ms - sum_ms, 0.0F);
  if (frames_.size() == kKept) frames_.erase(frames_.begin());
  frames_.push_back(times);
}

void TimingPane::draw(const Area& area, const look::Fonts& fonts) const {
  look::begin_pane("timing", area);
  ImDrawList* draw = ImGui::GetWindowDrawList();
  ImGui::PushFont(fonts.small);
  ImGui::PushStyleColor(ImGuiCol_Text, look::kDim);
  ImGui::TextUnformatted("TIME PER FRAME");
  ImGui::PopStyleColor();
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float legend = look::px(128.0F), beside = look::px(14.0F);
  const float width = std::max(room.x - legend - beside, look::px(20.0F)), height = room.y - look::px(4.0F);
  float top_ms = 1.2F * static_cast<float>(budget_ms_);
  std::vector<float> values;
  for (const Times& times : frames_) values.push_back(times.whole_ms);
  const float median_ms = median(values);
  top_ms = std::max(top_ms, 1.6F * median_ms);
  const auto y_of = [&](float ms) { return from.y + height * (1.0F - std::min(ms / top_ms, 1.0F)); };
  draw->AddRectFilled(from, {from.x + width, from.y + height}, look::kGround, look::px(4.0F));
  const float column = width / static_cast<float>(kKept);
  float x = from.x + column * static_cast<float>(kKept - frames_.size());
  for (const Times& times : frames_) {
    float below_ms = 0.0F;
    for (std::size_t i = 0; i < kStages.size(); ++i) {
      if (times.stages_ms[i] <= 0.0F) continue;
      const float above_ms = below_ms + times.stages_ms[i];
      draw->AddRectFilled({x, y_of(above_ms)}, {x + column, y_of(below_ms)}, kColours[i]);
      below_ms = above_ms;
    }
    x += column;
  }
  const struct {
    double ms;
    ImU32 colour;
  } lines[] = {{goal_ms(), IM_COL32(96, 200, 120, 200)}, {budget_ms_, IM_COL32(240, 178, 74, 200)}};
  std::array<char, 32> number{};
  for (const auto& line : lines) {
    format_classic(number.data(), number.size(), "%.3g ms", line.ms);
    const float y = y_of(static_cast<float>(line.ms));
    draw->AddLine({from.x, y}, {from.x + width, y}, line.colour, look::px(1.0F));
    look::note(*draw, {from.x + look::px(5.0F), y - look::px(16.0F)}, number.data(), line.colour, fonts);
  }

  draw_legend({from.x + width + beside, from.y, legend, height}, median_ms, fonts);
  ImGui::PopFont();
  look::end_pane();
}

void TimingPane::draw_legend(const Area& area, float median_ms, const look::Fonts& fonts) const {
  const float step = std::min(area.height / static_cast<float>(kStages.size() + 2), look::px(17.0F));
  ImDrawList* draw = ImGui::GetWindowDrawList();
  std::array<char, 32> number{};
  const auto row = [&](std::size_t at, ImU32 colour, const char* name, float ms, bool is_stage) {
    const float y = area.y + step * static_cast<float>(at);
    if (is_stage)
      draw->AddRectFilled({area.x, y + look::px(3.0F)}, {area.x + look::px(8.0F), y + look::px(11.0F)},
                          colour, look::px(2.0F));
    draw->AddText(fonts.small, fonts.small->FontSize, {area.x + look::px(14.0F), y},
                  is_stage ? look::kText : look::kDim, name);
    format_classic(number.data(), number.size(), "%.1f", static_cast<double>(ms));
    const float wide = ImGui::CalcTextSize(number.data()).x;
    draw->AddText(fonts.small, fonts.small->FontSize, {area.x + area.width - wide - look::px(2.0F), y},
                  is_stage ? look::kText : look::kDim, number.data());
  };
  std::vector<float> values;
  for (std::size_t i = 0; i < kStages.size(); ++i) {
    values.clear();
    for (const Times& times : frames_) values.push_back(times.stages_ms[i]);
    row(kStages.size() - 1 - i, kColours[i], kStages[i], median(values), true);  // in stacking order
  }
  row(kStages.size(), 0, "frame, median", median_ms, false);
  values.clear();
  for (const Times& times : frames_) values.push_back(times.read_ms);
  row(kStages.size() + 1, 0, "read, separate", median(values), false);
}

}  // namespace roomradar
