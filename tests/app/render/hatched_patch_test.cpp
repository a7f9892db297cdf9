// hatched_patch_test.cpp: stripes on the pixels that see a level disc, and nowhere else.
#include "app/render/hatched_patch.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace roomradar::hatched_patch_test {
namespace {

constexpr Intrinsics kCamera{160, 120, 150.0, 150.0, 79.5, 59.5};

/// Camera 1 m above the origin, looking straight down; image y is world -y.
Eigen::Isometry3d looking_down() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  T.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  return T;
}

int changed_pixels(const HatchedPatch& patch, float real_depth_m, int* outside = nullptr) {
  const Rgb grey{100, 100, 100};
  ColourImage picture(160, 120, grey);
  const DepthImage depth_m(160, 120, real_depth_m);
  hatch({&patch, 1}, kCamera, looking_down(), depth_m, picture);
  int changed = 0;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) {
      if (picture.at(x, y) == grey) continue;
      ++changed;
      const double radius_px = std::hypot(x - 79.5, y - 59.5);
      if (outside != nullptr && radius_px > patch.radius_m * 150.0 + 1.0) ++*outside;
    }
  return changed;
}

TEST(HatchedPatch, HalfOfTheDiscIsStripedAndNothingBesideIt) {
  int outside = 0;
  const int changed = changed_pixels({Eigen::Vector3d::Zero(), 0.2}, 0.0F, &outside);
  EXPECT_NEAR(changed, 0.5 * 3.14159 * 30.0 * 30.0, 60.0);
  EXPECT_EQ(outside, 0);
}

TEST(HatchedPatch, RealSurfaceInFrontHidesIt) {
  EXPECT_EQ(changed_pixels({Eigen::Vector3d::Zero(), 0.2}, 0.5F), 0);
  EXPECT_GT(changed_pixels({Eigen::Vector3d::Zero(), 0.2}, 0.99F), 1000);  // the floor itself, a little off
  EXPECT_GT(changed_pixels({Eigen::Vector3d::Zero(), 0.2}, 3.0F), 1000);
}

TEST(HatchedPatch, ThatCannotBeSeenOrIsNoDiscIsSkipped) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(changed_pixels({Eigen::Vector3d(0.0, 0.0, 2.0), 0.2}, 0.0F), 0);  // behind the camera
  EXPECT_EQ(changed_pixels({Eigen::Vector3d(0.0, 0.0, 1.0), 0.2}, 0.0F), 0);  // through it
  EXPECT_EQ(changed_pixels({Eigen::Vector3d::Zero(), 0.0}, 0.0F), 0);
  EXPECT_EQ(changed_pixels({Eigen::Vector3d::Zero(), kNan}, 0.0F), 0);
  EXPECT_EQ(changed_pixels({Eigen::Vector3d(kNan, 0.0, 0.0), 0.2}, 0.0F), 0);
}

}  // namespace
}  // namespace roomradar::hatched_patch_test
