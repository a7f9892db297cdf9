// observed_area_test.cpp: the area of a wall is counted once, however often it is observed.
#include "mapping/coverage/observed_area.hpp"

#include <gtest/gtest.h>

#include "tests/support/exact_depth.hpp"

namespace roomradar::observed_area_test {
namespace {

constexpr Intrinsics kCamera{640, 480, 585.0, 585.0, 319.5, 239.5};

Frame wall_at(double depth_m, double stamp_s) {
  Frame frame = test::exact_frame(test::plane(Eigen::Vector3d::UnitZ(), depth_m), kCamera,
                                  Eigen::Isometry3d::Identity());
  frame.stamp_s = stamp_s;
  return frame;
}

TEST(ObservedArea, OfAWallIsItsAreaAndSeeingItAgainAddsNothing) {
  ObservedArea seen;
  EXPECT_EQ(seen.total_m2(), 0.0);
  EXPECT_EQ(seen.last_second_m2(), 0.0);
  seen.add(wall_at(2.05, 0.0), Eigen::Isometry3d::Identity());
  // 640 / 585 x 480 / 585 of 2.05 m each way, and a border of half a cell.
  EXPECT_NEAR(seen.total_m2(), 2.05 * 2.05 * 640 * 480 / (585.0 * 585.0), 0.5);
  const double once_m2 = seen.total_m2();
  EXPECT_EQ(seen.last_second_m2(), once_m2);
  for (int i = 1; i <= 40; ++i) seen.add(wall_at(2.05, i / 30.0), Eigen::Isometry3d::Identity());
  EXPECT_EQ(seen.total_m2(), once_m2);
  EXPECT_EQ(seen.last_second_m2(), 0.0);
}

TEST(ObservedArea, GrowsWithTheCamerasWay) {
  ObservedArea seen;
  seen.add(wall_at(2.05, 0.0), Eigen::Isometry3d::Identity());
  const double before_m2 = seen.total_m2();
  const Eigen::Isometry3d aside(Eigen::Translation3d(1.0, 0.0, 0.0));
  seen.add(wall_at(2.05, 2.0), aside);
  EXPECT_NEAR(seen.total_m2() - before_m2, 2.05 * 480 / 585.0, 0.3);
  EXPECT_NEAR(seen.last_second_m2(), seen.total_m2() - before_m2, 1e-9);
}

TEST(ObservedArea, IgnoresWhatIsNotMeasuredOrFar) {
  ObservedArea seen;
  seen.add(wall_at(5.0, 0.0), Eigen::Isometry3d::Identity());
  seen.add(Frame{}, Eigen::Isometry3d::Identity());
  Frame nothing = wall_at(2.0, 0.1);
  std::fill(nothing.depth_m.pixels.begin(), nothing.depth_m.pixels.end(), 0.0F);
  seen.add(nothing, Eigen::Isometry3d::Identity());
  EXPECT_EQ(seen.total_m2(), 0.0);
}

}  // namespace
}  // namespace roomradar::observed_area_test
