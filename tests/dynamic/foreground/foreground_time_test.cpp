// foreground_time_test.cpp: the foreground history that carries over from frame to frame.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/dynamic/foreground/foreground_views.hpp"
#include "tests/support/allocation_count.hpp"

namespace roomradar::foreground_time_test {
namespace {

using namespace test;

// Consecutive frames.
struct Watch {
  ForegroundState state;
  Marked marked;

  void see(const DepthImage& live_m, const DepthImage& expected_m,
           const Eigen::Isometry3d& T_world_camera = Eigen::Isometry3d::Identity()) {
    marked.counts = mark_foreground({live_m, kKinect, T_world_camera}, expected_m, {}, state, marked.labels,
                                    marked.dynamic_mask);
  }
};

// A wall at 2 m and a square object in front of it, seen by a camera that has moved `right_m` to the right.
DepthImage wall_with(float square_m, int half_px, double right_m = 0.0) {
  DepthImage depth_m = flat(2.0F);
  const int x = 320 - static_cast<int>(std::lround(kKinect.fx_px * right_m / square_m));
  fill_rectangle(depth_m, x - half_px, 240 - half_px, x + half_px, 240 + half_px, square_m);
  return depth_m;
}

TEST(ForegroundInTime, SmallThingIsBelievedInTheSecondFrame) {
  Watch run;
  const DepthImage live_m = wall_with(1.5F, 5);
  run.see(live_m, flat(2.0F));
  EXPECT_EQ(run.marked.counts.moved, 0U);
  EXPECT_EQ(run.marked.labels.at(320, 240), PixelLabel::kNotKnown);
  run.see(live_m, flat(2.0F));
  EXPECT_EQ(run.marked.counts.moved, 100U);
}

TEST(ForegroundInTime, FlashOfOneFrameIsNeverMarked) {
  Watch run;
  for (int frame = 0; frame < 6; ++frame) {
    run.see(frame % 2 == 0 ? wall_with(1.5F, 5) : flat(2.0F), flat(2.0F));
    EXPECT_EQ(run.marked.counts.moved, 0U) << frame;
  }
}

TEST(ForegroundInTime, SmallThingIsFoundAgainWhereTheCameraMovedOn) {
  Watch run;
  run.see(wall_with(1.5F, 5), flat(2.0F));
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.translation().x() = 0.15;  // 58 px at the object's depth: no pixel of it stays in place
  run.see(wall_with(1.5F, 5, 0.15), flat(2.0F), T_world_camera);
  EXPECT_EQ(run.marked.counts.moved, 100U);

  Watch elsewhere;  // an object as new at its position as the previous one
  elsewhere.see(wall_with(1.5F, 5), flat(2.0F));
  elsewhere.see(wall_with(1.5F, 5, 0.15), flat(2.0F));
  EXPECT_EQ(elsewhere.marked.counts.moved, 0U);
}

TEST(ForegroundInTime, WhatWasMarkedStaysWhileItComesNearerToTheWall) {
  // A palm that moves towards a wall 1 m away. Without history it is lost earlier than with it.
  const DepthImage wall_m = flat(1.0F);
  float lost_watched_m = 0.0F, lost_alone_m = 0.0F;
  Watch watched;
  for (float before_m = 0.05F; before_m > 0.005F; before_m -= 0.001F) {
    DepthImage live_m = flat(1.0F);
    fill_rectangle(live_m, 250, 180, 390, 300, 1.0F - before_m);
    watched.see(live_m, wall_m);
    if (watched.marked.counts.moved > 0) lost_watched_m = before_m;
    if (mark(live_m, wall_m).counts.moved > 0) lost_alone_m = before_m;
  }
  EXPECT_LT(lost_watched_m, lost_alone_m - 0.003F);
  EXPECT_LT(lost_alone_m, 0.03F);
}

TEST(ForegroundInTime, WhatLeftLeavesNothingBehind) {
  Watch run;
  for (int frame = 0; frame < 3; ++frame) {
    DepthImage live_m = wall_with(1.0F, 60);
    add_noise(live_m, 10 + static_cast<unsigned>(frame));
    run.see(live_m, flat(2.0F));
    EXPECT_GT(run.marked.counts.moved, 14000U);
  }
  DepthImage live_m = flat(2.0F);
  add_noise(live_m, 20);
  run.see(live_m, flat(2.0F));
  EXPECT_EQ(run.marked.counts.moved, 0U);
}

// A box 100 px wide at box_m in a view of which the map knows the lowest rows only, moved to column x.
DepthImage unmapped_view(float behind_m, float box_m, int x) {
  DepthImage depth_m = flat(behind_m);
  fill_rectangle(depth_m, 0, 400, 640, 480, 1.0F);
  if (box_m > 0.0F) fill_rectangle(depth_m, x, 200, x + 100, 300, box_m);
  return depth_m;
}

DepthImage mapped_below() {
  DepthImage expected_m = flat(0.0F);
  fill_rectangle(expected_m, 0, 400, 640, 480, 1.0F);
  return expected_m;
}

TEST(ForegroundInTime, WhatComesIntoUnmappedSpaceIsMovedAsAWhole) {
  // Nothing, or something, is measured behind it; it is nearer or farther than the mapped surface in view.
  for (const auto& [behind_m, box_m] : {std::pair{0.0F, 0.7F}, {0.0F, 2.0F}, {3.0F, 0.7F}, {3.0F, 2.0F}}) {
    Watch run;
    run.see(unmapped_view(behind_m, box_m, 0), mapped_below());  // it is there from the start
    for (int x = 0; x < 300; x += 6) {
      DepthImage live_m = unmapped_view(behind_m, box_m, x);
      add_noise(live_m, static_cast<unsigned>(x));
      run.see(live_m, mapped_below());
      if (x < 120) continue;
      const auto box = [&](int u, int v) { return u >= x && u < x + 100 && v >= 200 && v < 300; };
      EXPECT_GT(intersection_over_union(run.marked.dynamic_mask, box), 0.97)
          << behind_m << " m behind " << box_m << " m at " << x;
    }
  }
}

TEST(ForegroundInTime, WhatMovesInUnmappedSpaceIsMovedBeforeItHasLeftItsPlace) {
  // Nothing is measured behind it. It is there from the start, 300 px wide, and moves by 150 px in all.
  Watch run;
  const auto view = [](int x) {
    DepthImage depth_m = unmapped_view(0.0F, 0.0F, 0);
    fill_rectangle(depth_m, x, 100, x + 300, 300, 2.0F);
    return depth_m;
  };
  for (int frame = 0; frame < 10; ++frame) run.see(view(100), mapped_below());
  EXPECT_EQ(run.marked.counts.moved, 0U) << "it has not moved yet";
  for (int x = 100; x <= 250; x += 6) {
    DepthImage live_m = view(x);
    add_noise(live_m, static_cast<unsigned>(x));
    run.see(live_m, mapped_below());
    if (x < 190) continue;
    const auto thing = [&](int u, int v) { return u >= x && u < x + 300 && v >= 100 && v < 300; };
    EXPECT_GT(intersection_over_union(run.marked.dynamic_mask, thing), 0.97) << x;
  }
}

TEST(ForegroundInTime, WhatFlickersInUnmappedSpaceIsNotMoved) {
  // A surface that is measured in half of its squares of 12 px, others in each frame, and whose outline
  // jumps by 4 px to all sides.
  Watch run;
  std::mt19937 random(3);
  for (int frame = 0; frame < 60; ++frame) {
    DepthImage live_m = unmapped_view(0.0F, 0.0F, 0);
    const int dx = static_cast<int>(random() % 9) - 4, dy = static_cast<int>(random() % 9) - 4;
    fill_rectangle(live_m, 150 + dx, 60 + dy, 450 + dx, 300 + dy, 4.0F);
    for (int y = 60; y < 180; y += 12)
      for (int x = 150; x < 450; x += 12)
        if (random() % 2 == 0) fill_rectangle(live_m, x, y, x + 12, y + 12, 0.0F);
    add_noise(live_m, static_cast<unsigned>(frame));
    run.see(live_m, mapped_below());
    EXPECT_EQ(run.marked.counts.moved, 0U) << frame;
  }
}

TEST(ForegroundInTime, WhatStandsInUnmappedSpaceIsNotMovedByTheCamerasMotion) {
  // The camera moves 15 cm to the right and turns; the box and the wall behind it stand.
  for (const float behind_m : {0.0F, 3.0F}) {
    Watch run;
    for (int frame = 0; frame < 60; ++frame) {
      const double right_m = 0.0025 * frame;
      DepthImage live_m = unmapped_view(behind_m, 1.2F, 0);
      fill_rectangle(live_m, 0, 200, 100, 300, behind_m);
      const int x = 320 - static_cast<int>(std::lround(kKinect.fx_px * right_m / 1.2));
      fill_rectangle(live_m, x, 200, x + 100, 300, 1.2F);
      add_noise(live_m, static_cast<unsigned>(frame));
      Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
      T_world_camera.translation().x() = right_m;
      run.see(live_m, mapped_below(), T_world_camera);
      EXPECT_EQ(run.marked.counts.moved, 0U) << frame << ", " << behind_m << " m behind";
    }
  }
}

TEST(ForegroundInTime, WhatHasComeIntoUnmappedSpaceAndStandsIsNoLongerMoved) {
  Watch run;
  for (int frame = 0; frame < 10; ++frame) run.see(unmapped_view(0.0F, 0.0F, 0), mapped_below());
  int moved_frames = 0;
  for (int frame = 0; frame < 300; ++frame) {
    run.see(unmapped_view(0.0F, 0.7F, 200), mapped_below());
    moved_frames += run.marked.counts.moved > 0 ? 1 : 0;
  }
  EXPECT_GT(moved_frames, 60);
  EXPECT_LT(moved_frames, 200);
  EXPECT_EQ(run.marked.labels.at(250, 250), PixelLabel::kUnmapped) << "but it is there";
}

TEST(ForegroundInTime, AMapThatFitsBadlyIsTrustedLess) {
  // 1.5 cm between map and room, at 1 m; then they agree again.
  Watch run;
  DepthImage live_m = flat(1.0F);
  for (int frame = 0; frame < 3; ++frame) run.see(live_m, flat(1.015F));
  EXPECT_EQ(run.marked.counts.moved, 0U);
  EXPECT_GT(run.state.fit.misfit_per_m, 0.005F);
  for (int frame = 0; frame < 60; ++frame) run.see(live_m, flat(1.0F));
  EXPECT_LT(run.state.fit.misfit_per_m, 0.001F);
}

TEST(ForegroundInTime, AnotherCameraRemembersNothing) {
  Watch run;
  run.see(wall_with(1.5F, 5), flat(2.0F));
  Intrinsics wider = kKinect;
  wider.fx_px = wider.fy_px = 500.0;
  const ForegroundCounts counts =
      mark_foreground({wall_with(1.5F, 5), wider, Eigen::Isometry3d::Identity()}, flat(2.0F), {}, run.state,
                      run.marked.labels, run.marked.dynamic_mask);
  EXPECT_EQ(counts.moved, 0U);
}

TEST(ForegroundInTime, NothingIsAllocatedAfterTheFirstFrame) {
  Watch run;
  DepthImage live_m = flat(2.0F);
  const DepthImage expected_m = table_view(0.0, 0.0);
  run.see(live_m, expected_m);
  DepthImage all_m = flat(0.45F), noise_m = flat(1.2F);
  add_noise(noise_m, 30);
  for (std::size_t i = 0; i < noise_m.pixels.size(); i += 2) noise_m.pixels[i] *= 0.7F;  // max number of runs
  const std::size_t before = allocations;
  run.see(live_m, expected_m);
  run.see(all_m, expected_m);
  run.see(noise_m, expected_m);
  run.see(expected_m, expected_m);
  EXPECT_EQ(allocations - before, 0U);
}

}  // namespace
}  // namespace roomradar::foreground_time_test
