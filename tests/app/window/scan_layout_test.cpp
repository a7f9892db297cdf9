// scan_layout_test.cpp: the panes of the scan window fill every size of window without overlapping.
#include "app/window/scan/scan_layout.hpp"

#include <gtest/gtest.h>

#include <array>

namespace roomradar::scan_layout_test {
namespace {

TEST(ScanLayout, PanesFillEverySizeOfWindow) {
  constexpr std::array<std::array<float, 3>, 6> kWindows = {{{640, 480, 1.0F},
                                                             {800, 1200, 1.0F},
                                                             {1280, 800, 1.0F},
                                                             {1280, 960, 2.0F},
                                                             {1920, 1080, 1.5F},
                                                             {3840, 2160, 2.5F}}};
  for (const auto& [width, height, scale] : kWindows) {
    const ScanLayout layout = scan_layout(width, height, scale);
    double area = 0.0;
    for (const Area& pane : {layout.bar, layout.camera, layout.model, layout.counts}) {
      EXPECT_FALSE(pane.empty()) << width << " x " << height;
      EXPECT_GE(pane.x, 0.0F);
      EXPECT_GE(pane.y, 0.0F);
      EXPECT_LE(pane.x + pane.width, width + 0.01F);
      EXPECT_LE(pane.y + pane.height, height + 0.01F);
      area += static_cast<double>(pane.width) * static_cast<double>(pane.height);
    }
    EXPECT_NEAR(area, static_cast<double>(width) * static_cast<double>(height), 1.0);
    const bool are_apart = layout.camera.x + layout.camera.width <= layout.model.x + 0.01F ||
                           layout.camera.y + layout.camera.height <= layout.model.y + 0.01F;
    EXPECT_TRUE(are_apart);
  }
}

}  // namespace
}  // namespace roomradar::scan_layout_test
