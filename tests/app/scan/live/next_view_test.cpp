// next_view_test.cpp: what is free, occupied and unknown, and where to look next, in rooms known exactly.
#include "app/scan/live/next_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/exact_depth.hpp"
#include "tests/support/stored_view.hpp"

namespace roomradar::next_view_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr Intrinsics kCamera{320, 240, 292.0, 292.0, 159.5, 119.5};

/// A closed room of 5.06 x 5.06 x 2.6 m about the origin, with the floor at z = 0.
test::Scene closed_room() {
  test::Scene room = test::nearest_of(test::plane({0, 0, 1}, 0.0), test::plane({0, 0, 1}, 2.6));
  for (const double side : {-2.53, 2.53})
    room =
        test::nearest_of(room, test::nearest_of(test::plane({1, 0, 0}, side), test::plane({0, 1, 0}, side)));
  return room;
}

Keyframe keyframe(const test::Scene& scene, const Isometry3d& T_world_camera) {
  Keyframe made;
  made.T_world_camera = T_world_camera;
  made.view = test::stored_view(test::exact_frame(scene, kCamera, T_world_camera));
  return made;
}

Isometry3d looking(double azimuth_rad, double height_m) {
  return test::looking_at({0.0, 0.0, 1.3}, {std::cos(azimuth_rad), std::sin(azimuth_rad), height_m});
}

TEST(ExplorationGrid, KnowsFreeOccupiedAndUnknown) {
  const std::vector<Keyframe> keyframes = {keyframe(closed_room(), looking(0.0, 1.3))};
  const ExplorationGrid grid = explored_around({0.0, 0.0, 1.3}, keyframes);
  EXPECT_EQ(grid.at({1.5, 0.05, 1.3}), CellState::kFree);
  EXPECT_EQ(grid.at({2.55, 0.05, 1.3}), CellState::kOccupied);
  EXPECT_EQ(grid.at({3.0, 0.0, 1.3}), CellState::kUnknown);   // behind the wall
  EXPECT_EQ(grid.at({-1.0, 0.0, 1.3}), CellState::kUnknown);  // behind the camera
  EXPECT_EQ(grid.at({100.0, 0.0, 1.3}), CellState::kUnmeasurable);
  EXPECT_EQ(explored_around({0.0, 0.0, 1.3}, {}).at({1.0, 0.0, 1.3}), CellState::kUnknown);
}

TEST(ExplorationGrid, GivesUpOnWhatSeveralViewsCouldNotMeasure) {
  const test::Scene nothing = [](const Vector3d&, const Vector3d&) { return test::kNoHit; };
  std::vector<Keyframe> keyframes = {keyframe(nothing, looking(0.0, 1.3))};
  EXPECT_EQ(explored_around({0, 0, 1.3}, keyframes).at({1.5, 0.05, 1.3}), CellState::kUnknown);
  for (int i = 0; i < 40; ++i) keyframes.push_back(keyframes.front());
  EXPECT_EQ(explored_around({0, 0, 1.3}, keyframes).at({1.5, 0.05, 1.3}), CellState::kUnmeasurable);
}

TEST(NextView, TurnsToWhatWasNotSeen) {
  // All directions except +y.
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < 24; ++i) {
    const double azimuth_rad = 2.0 * std::numbers::pi * i / 24;
    if (std::abs(std::remainder(azimuth_rad - 0.5 * std::numbers::pi, 2.0 * std::numbers::pi)) < 1.0)
      continue;
    for (const double height_m : {0.5, 1.3, 2.2})
      keyframes.push_back(keyframe(closed_room(), looking(azimuth_rad, height_m)));
  }
  const Isometry3d camera = looking(0.0, 1.2);
  const auto next = best_next_view(explored_around({0, 0, 1.3}, keyframes), camera, Vector3d::UnitZ());
  ASSERT_TRUE(next);
  EXPECT_GT(next->T_world_camera.linear().col(2).y(), 0.5);
  EXPECT_GT(next->gain_m2, 0.5);
  EXPECT_GT(next->takes_s, 0.5);
  EXPECT_NE(way_to(*next, camera, Vector3d::UnitZ()).find("turn left"), std::string::npos);
  // Its image is upright.
  EXPECT_NEAR(next->T_world_camera.linear().col(0).z(), 0.0, 1e-9);
  EXPECT_LT(next->T_world_camera.linear().col(1).z(), 0.0);
}

TEST(NextView, IsNoneInARoomThatIsSeen) {
  std::vector<Keyframe> keyframes;  // fewer than the 200 that the grid takes
  for (const double x : {-1.0, 1.0})
    for (int i = 0; i < 16; ++i)
      for (const double height_m : {-0.6, 0.4, 1.3, 2.2, 3.0}) {
        Isometry3d view = looking(2.0 * std::numbers::pi * i / 16, height_m);
        view.translation().x() += x;
        keyframes.push_back(keyframe(closed_room(), view));
      }
  const auto next =
      best_next_view(explored_around({0, 0, 1.3}, keyframes), looking(0.0, 1.2), Vector3d::UnitZ());
  EXPECT_FALSE(next) << next->gain_m2 << " m2";
}

TEST(NextView, OfAPointHasItInTheMiddleOfALevelImage) {
  for (const Vector3d& point : {Vector3d(1, 2, 0.3), Vector3d(0.5, 0.5, 0.0), Vector3d(0.5, 0.5, 3.0)}) {
    const Vector3d viewpoint(0.5, 0.5, 1.4);
    const Isometry3d view = view_of(point, viewpoint, Vector3d::UnitZ()).T_world_camera;
    ASSERT_TRUE(view.matrix().allFinite());
    EXPECT_EQ(view.translation(), viewpoint);
    EXPECT_NEAR(view.linear().determinant(), 1.0, 1e-9);
    const Vector3d seen = view.inverse() * point;
    EXPECT_GT(seen.z(), 0.0);
    EXPECT_LT(seen.head<2>().norm(), 0.01);
    EXPECT_NEAR(view.linear().col(0).z(), 0.0, 1e-9);
  }
}

TEST(NextView, WayInWords) {
  NextView next;
  const Isometry3d camera = looking(0.0, 1.3);  // forward is +x, left is +y
  next.T_world_camera = camera;
  EXPECT_EQ(way_to(next, camera, Vector3d::UnitZ()), "hold still");
  next.T_world_camera.translation() += Vector3d(0.8, -0.5, 0.4);
  EXPECT_EQ(way_to(next, camera, Vector3d::UnitZ()),
            "go forward 0.8 m, go right 0.5 m, hold higher by 0.4 m");
  next.T_world_camera = looking(-1.0, 1.3);
  EXPECT_EQ(way_to(next, camera, Vector3d::UnitZ()), "turn right 60\u00B0");
  next.T_world_camera = looking(0.0, 0.2);
  EXPECT_EQ(way_to(next, camera, Vector3d::UnitZ()), "tilt down 50\u00B0");  // 48 degrees
  // A camera that looks straight down.
  const Isometry3d down = test::looking_at({0.0, 0.0, 1.3}, {1e-3, 0.0, 0.0});
  EXPECT_FALSE(way_to(next, down, Vector3d::UnitZ()).empty());
}

}  // namespace
}  // namespace roomradar::next_view_test
