// surface_motion_test.cpp: how far a hand of points has moved between two frames.
#include "dynamic/surface/surface_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace roomradar::surface_motion_test {
namespace {

using Vec3 = Eigen::Vector3d;
using Points = std::vector<Vec3>;

constexpr double kReach_m = 0.3, kFarthest_m = 0.15;

/// Upper half of an arm along x that ends at `tip`, with two fingers, as seen from above.
Points arm(const Vec3& tip, double length_m, double spacing_m = 0.006) {
  Points points;
  const auto add_half_cylinder = [&](double from_m, double to_m, double y_m, double radius_m) {
    for (double x = from_m; x < to_m; x += spacing_m)
      for (double y = -radius_m; y <= radius_m; y += spacing_m)
        points.push_back(tip + Vec3(-x, y_m + y, std::sqrt(radius_m * radius_m - y * y)));
  };
  add_half_cylinder(0.0, 0.08, -0.02, 0.01);
  add_half_cylinder(0.0, 0.07, 0.02, 0.01);
  add_half_cylinder(0.08, length_m, 0.0, 0.035);
  return points;
}

Points moved(Points points, const Vec3& way) {
  for (Vec3& p : points) p += way;
  return points;
}

TEST(SurfaceMotion, IsTheTranslationOfAHandInAnyDirection) {
  const Points before = arm(Vec3(2.0, -1.0, 0.8), 0.5);
  for (const Vec3& way : {Vec3(0.1, 0, 0), Vec3(-0.1, 0, 0), Vec3(0, 0.1, 0), Vec3(0.06, -0.06, 0.05),
                          Vec3(0.003, 0.002, 0), Vec3(0, 0, -0.12)}) {
    const Points now = moved(before, way);
    const auto found = translation_near(before, now, Vec3(2.05, -1.0, 0.8) + way, kReach_m, kFarthest_m);
    ASSERT_TRUE(found) << way.transpose();
    EXPECT_LT((*found - way).norm(), 0.008) << way.transpose() << ", found " << found->transpose();
  }
}

TEST(SurfaceMotion, OfAnArmThatComesIntoViewIsThatOfItsTip) {
  // Seen for the first 15 cm, then for 25 cm: more of the arm has come into view.
  const Points before = arm(Vec3(0.0, 0.0, 1.0), 0.15), now = arm(Vec3(0.1, 0.0, 1.0), 0.25);
  const auto found = translation_near(before, now, Vec3(0.15, 0.0, 1.0), kReach_m, kFarthest_m);
  ASSERT_TRUE(found);
  EXPECT_LT((*found - Vec3(0.1, 0, 0)).norm(), 0.01) << found->transpose();
}

TEST(SurfaceMotion, OfWhatIsFarFromTheObjectDoesNotCount) {
  // A person walks 2 m away; the hand near the object rests.
  Points before = arm(Vec3::Zero(), 0.3), now = before;
  for (const Vec3& p : arm(Vec3(0, 2, 0), 0.5)) {
    before.push_back(p);
    now.push_back(p + Vec3(0.1, 0.05, 0));
  }
  const auto found = translation_near(before, now, Vec3(0.05, 0, 0), kReach_m, kFarthest_m);
  ASSERT_TRUE(found);
  EXPECT_LT(found->norm(), 0.002);
}

TEST(SurfaceMotion, IsNotKnownOfFewPointsOrOfAnotherThing) {
  const Points hand = arm(Vec3::Zero(), 0.3);
  EXPECT_FALSE(translation_near({}, hand, Vec3::Zero(), kReach_m, kFarthest_m));
  EXPECT_FALSE(translation_near(hand, {}, Vec3::Zero(), kReach_m, kFarthest_m));
  EXPECT_FALSE(
      translation_near(hand, Points(hand.begin(), hand.begin() + 11), Vec3::Zero(), kReach_m, kFarthest_m));
  EXPECT_FALSE(translation_near(hand, hand, Vec3(0, 0, 1), kReach_m, kFarthest_m));  // out of reach
  // What came is 20 cm away from what was there.
  EXPECT_FALSE(translation_near(moved(hand, Vec3(0, 0.25, 0)), hand, Vec3::Zero(), kReach_m, 0.1));
  const Points nan(20, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(translation_near(hand, nan, Vec3::Zero(), kReach_m, kFarthest_m));
}

TEST(SurfaceMotion, PointsAreThoseOfDynamicPixelsWithDepth) {
  const Intrinsics camera{8, 6, 10.0, 10.0, 3.5, 2.5};
  DepthImage depth_m(8, 6, 2.0F);
  MaskImage mask(8, 6);
  mask.at(2, 1) = mask.at(3, 1) = mask.at(4, 1) = 1;
  depth_m.at(3, 1) = 0.0F;
  depth_m.at(4, 1) = std::numeric_limits<float>::quiet_NaN();
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  T_world_camera.translation().x() = 1.0;
  Points points;
  dynamic_points(depth_m, mask, camera, T_world_camera, points);
  ASSERT_EQ(points.size(), 1U);
  EXPECT_LT((points[0] - Vec3(1.0 + (2 - 3.5) / 10.0 * 2.0, (1 - 2.5) / 10.0 * 2.0, 2.0)).norm(), 1e-9);
}

}  // namespace
}  // namespace roomradar::surface_motion_test
