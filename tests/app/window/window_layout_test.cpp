// window_layout_test.cpp: the panes fill every size of window without overlapping.
#include "app/window/panes/window_layout.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace roomradar::window_layout_test {
namespace {

bool overlap(const Area& a, const Area& b) {
  constexpr float kRounding = 0.01F;
  return !a.empty() && !b.empty() && a.x + kRounding < b.x + b.width && b.x + kRounding < a.x + a.width &&
         a.y + kRounding < b.y + b.height && b.y + kRounding < a.y + a.height;
}

TEST(WindowLayout, PanesFillEverySizeOfWindowWithoutOverlap) {
  constexpr std::array<std::array<float, 3>, 7> kWindows = {{{640, 480, 1.0F},
                                                             {800, 600, 1.0F},
                                                             {1280, 800, 1.0F},
                                                             {1280, 800, 2.0F},
                                                             {1920, 1080, 1.5F},
                                                             {3840, 2160, 1.0F},
                                                             {3840, 2160, 2.5F}}};
  for (const auto& [width, height, scale] : kWindows)
    for (const MainView view : {MainView::kCamera, MainView::kModels, MainView::kBoth}) {
      const WindowLayout layout = window_layout(width, height, view, scale);
      const std::array<Area, 6> panes = {layout.bar,  layout.camera, layout.models,
                                         layout.side, layout.timing, layout.radar};
      float area = 0.0F;
      for (std::size_t i = 0; i < panes.size(); ++i) {
        if (panes[i].empty()) continue;
        EXPECT_GE(panes[i].x, 0.0F);
        EXPECT_LE(panes[i].x + panes[i].width, width + 0.5F);
        EXPECT_LE(panes[i].y + panes[i].height, height + 0.5F);
        area += panes[i].width * panes[i].height;
        for (std::size_t j = 0; j < i; ++j) EXPECT_FALSE(overlap(panes[i], panes[j])) << i << " and " << j;
      }
      EXPECT_NEAR(area / (width * height), 1.0F, 0.01F) << width << " x " << height;
      const Area main = view == MainView::kModels ? layout.models : layout.camera;
      EXPECT_GE(main.width, view == MainView::kBoth ? 150.0F : 300.0F) << width << " x " << height;
      EXPECT_GE(main.height, 250.0F) << width << " x " << height;
    }
}

TEST(WindowLayout, ASmallWindowReducesTheScale) {
  EXPECT_EQ(scale_in_window(2.0F, 3840.0F, 2160.0F), 2.0F);
  EXPECT_EQ(scale_in_window(2.0F, 1280.0F, 720.0F), 1.5F);
  EXPECT_EQ(scale_in_window(2.0F, 1920.0F, 1030.0F), 2.0F);
  EXPECT_EQ(scale_in_window(4.0F, 1920.0F, 1030.0F), 2.125F) << "in steps of 1/8";
  EXPECT_EQ(scale_in_window(2.0F, 640.0F, 480.0F), 1.0F);
  EXPECT_EQ(scale_in_window(2.0F, 500.0F, 400.0F), 1.0F);
  EXPECT_EQ(scale_in_window(0.5F, 500.0F, 400.0F), 0.5F) << "as asked for";
}

TEST(WindowLayout, LabelsAreShiftedInsideTheirPane) {
  EXPECT_EQ(shifted_inside(20.0F, 50.0F, 10.0F, 100.0F), 20.0F) << "fits already";
  EXPECT_EQ(shifted_inside(80.0F, 50.0F, 10.0F, 100.0F), 50.0F) << "would be cut at the right";
  EXPECT_EQ(shifted_inside(2.0F, 50.0F, 10.0F, 100.0F), 10.0F) << "would be cut at the left";
  EXPECT_EQ(shifted_inside(30.0F, 200.0F, 10.0F, 100.0F), 10.0F) << "too long: its beginning is shown";
}

}  // namespace
}  // namespace roomradar::window_layout_test
