// start_layout_test.cpp: the panes of the start view fill every size of window without overlapping.
#include "app/window/start/start_layout.hpp"

#include <gtest/gtest.h>

#include <array>

namespace roomradar::start_layout_test {
namespace {

bool are_apart(const Area& a, const Area& b) {
  return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
}

TEST(StartLayout, PanesFillEverySizeOfWindow) {
  constexpr std::array<std::array<float, 3>, 6> kWindows = {{{640, 480, 1.0F},
                                                             {640, 480, 0.75F},
                                                             {1280, 800, 1.0F},
                                                             {1280, 960, 2.0F},
                                                             {1920, 1080, 1.5F},
                                                             {3840, 2160, 2.5F}}};
  for (const auto& [width, height, scale] : kWindows) {
    const StartLayout layout = start_layout(width, height, scale);
    const std::array<Area, 5> panes = {layout.bar, layout.sources, layout.maps, layout.detail,
                                       layout.actions};
    double area = 0.0;
    for (std::size_t i = 0; i < panes.size(); ++i) {
      EXPECT_FALSE(panes[i].empty()) << width << " x " << height;
      EXPECT_GE(panes[i].x, 0.0F);
      EXPECT_GE(panes[i].y, 0.0F);
      EXPECT_LE(panes[i].x + panes[i].width, width);
      EXPECT_LE(panes[i].y + panes[i].height, height);
      area += static_cast<double>(panes[i].width) * static_cast<double>(panes[i].height);
      for (std::size_t j = 0; j < i; ++j) EXPECT_TRUE(are_apart(panes[i], panes[j])) << i << " " << j;
    }
    EXPECT_NEAR(area, static_cast<double>(width) * static_cast<double>(height), 1.0);
  }
}

}  // namespace
}  // namespace roomradar::start_layout_test
