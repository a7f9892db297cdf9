// placement_test.cpp: placement on a table and a floor, in depth images cast ray by ray.
#include "app/physics/placement/placement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::placement_test {
namespace {

using Vec3 = Eigen::Vector3d;

const Intrinsics kCamera{320, 240, 262.5, 262.5, 159.5, 119.5};

struct Box {
  Vec3 low, high;
};

Eigen::Isometry3d looking(const Vec3& from, const Vec3& at) {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  const Vec3 z = (at - from).normalized();
  const Vec3 x = z.cross(Vec3::UnitZ()).normalized();
  T_world_camera.linear() << x, z.cross(x), z;
  T_world_camera.translation() = from;
  return T_world_camera;
}

/// Exact depth of boxes, optionally with a Kinect's noise.
DepthImage view_of(const std::vector<Box>& boxes, const Eigen::Isometry3d& T_world_camera,
                   bool is_noisy = false) {
  DepthImage depth_m(kCamera.width_px, kCamera.height_px);
  std::mt19937 random(3);
  std::normal_distribution<float> unit;
  for (int v = 0; v < kCamera.height_px; ++v) {
    for (int u = 0; u < kCamera.width_px; ++u) {
      const Vec3 ray = T_world_camera.linear() * back_project(kCamera, u, v, 1.0);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Box& box : boxes) {
        const Vec3 a = (box.low - T_world_camera.translation()).cwiseQuotient(ray);
        const Vec3 b = (box.high - T_world_camera.translation()).cwiseQuotient(ray);
        const double enter = a.cwiseMin(b).maxCoeff();
        const double leave = a.cwiseMax(b).minCoeff();
        if (enter > 0.0 && enter < leave) nearest = std::min(nearest, enter);
      }
      if (!std::isfinite(nearest)) continue;
      float z_m = static_cast<float>(nearest);
      if (is_noisy) z_m += depth_sigma_m(DepthNoise{}, z_m) * unit(random);
      depth_m.at(u, v) = z_m;
    }
  }
  return depth_m;
}

const Box kFloor{{-5, -5, -0.1}, {5, 5, 0}};
const Box kTable{{-0.6, -0.4, 0.70}, {0.6, 0.4, 0.73}};

TEST(Placement, FindsTheMiddleOfATable) {
  const Eigen::Isometry3d T_world_camera = looking({0, -1.2, 1.4}, {0, 0, 0.7});
  for (const bool is_noisy : {false, true}) {
    const Support support =
        find_support(view_of({kFloor, kTable}, T_world_camera, is_noisy), kCamera, T_world_camera, {0.12});
    ASSERT_TRUE(support) << is_noisy;
    EXPECT_NEAR(support.point_world.z(), 0.73, is_noisy ? 0.008 : 0.002);
    EXPECT_LT(std::abs(support.point_world.x()), 0.6 - 0.12);
    EXPECT_LT(std::abs(support.point_world.y()), 0.4 - 0.12);
    EXPECT_LT(support.point_world.head<2>().norm(), 0.25);
  }
}

TEST(Placement, TakesThePlaceNearestToTheMiddleOfTheView) {
  // Looks at the floor beside the table, then at the table: both have places.
  for (const double height_m : {0.0, 0.73}) {
    const Vec3 at(height_m > 0.0 ? 0.1 : 1.5, 0.0, height_m);
    const Eigen::Isometry3d T_world_camera = looking({at.x(), -1.6, 1.6}, at);
    const Support support =
        find_support(view_of({kFloor, kTable}, T_world_camera), kCamera, T_world_camera, {0.1});
    ASSERT_TRUE(support);
    EXPECT_LT((support.point_world - at).norm(), 0.03) << height_m;
  }
}

TEST(Placement, TakesThePlaceNearestToAPointWithinReach) {
  const Eigen::Isometry3d T_world_camera = looking({0, -1.2, 1.4}, {0, 0, 0.7});
  const DepthImage depth_m = view_of({kFloor, kTable}, T_world_camera);
  const Support there = find_support(depth_m, kCamera, T_world_camera, {0.1, Vec3(0.3, 0.1, 0.73)});
  ASSERT_TRUE(there);
  EXPECT_LT((there.point_world - Vec3(0.3, 0.1, 0.73)).norm(), 0.03);
  // At the table's edge: moved inwards by footprint and margin.
  const Support inside = find_support(depth_m, kCamera, T_world_camera, {0.1, Vec3(0.59, 0.0, 0.73)});
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside.point_world.x(), 0.6 - 0.1 - PlacementConfig{}.room_to_spare_m, 0.03);
  EXPECT_EQ(find_support(depth_m, kCamera, T_world_camera, {0.1, Vec3(0.0, 0.0, 1.5)}).status,
            SupportStatus::kTooFar);
  EXPECT_EQ(find_support(depth_m, kCamera, T_world_camera, {0.1, Vec3(std::nan(""), 0.0, 0.73)}).status,
            SupportStatus::kInvalidInput);
}

TEST(Placement, AsksIfAPlaceIsFreeAndSaysThatNoneIs) {
  const Eigen::Isometry3d T_world_camera = looking({0, -1.2, 1.4}, {0, 0, 0.7});
  const DepthImage depth_m = view_of({kFloor, kTable}, T_world_camera);
  int tried = 0;
  const Support left = find_support(depth_m, kCamera, T_world_camera, {0.1, {}, [&](const Vec3& p) {
                                                                         ++tried;
                                                                         return p.x() < -0.1;
                                                                       }});
  ASSERT_TRUE(left);
  EXPECT_LT(left.point_world.x(), -0.1);
  EXPECT_GT(left.point_world.x(), -0.2);
  EXPECT_GT(tried, 1);
  EXPECT_EQ(
      find_support(depth_m, kCamera, T_world_camera, {0.1, {}, [](const Vec3&) { return false; }}).status,
      SupportStatus::kBlocked);
}

TEST(Placement, SaysWhyThereIsNoPlace) {
  const Eigen::Isometry3d wall = looking({0, -2.0, 1.2}, {0, 0, 1.2});
  EXPECT_EQ(find_support(view_of({{{-3, 0, -3}, {3, 0.1, 5}}}, wall), kCamera, wall, {0.1}).status,
            SupportStatus::kNotLevel);
  const Eigen::Isometry3d from_above = looking({0, -1.0, 1.4}, {0, 0, 0.5});
  const Box stool{{-0.1, -0.1, 0.4}, {0.1, 0.1, 0.45}};
  EXPECT_EQ(find_support(view_of({stool}, from_above), kCamera, from_above, {0.15}).status,
            SupportStatus::kTooSmall);
  EXPECT_EQ(find_support(DepthImage(320, 240), kCamera, from_above, {0.15}).status,
            SupportStatus::kNothingMeasured);
  EXPECT_EQ(find_support(DepthImage{}, kCamera, from_above, {0.15}).status, SupportStatus::kInvalidInput);
}

TEST(Placement, TakesTheFloorWhereThereIsNothingElse) {
  const Eigen::Isometry3d T_world_camera = looking({0, -1.5, 1.4}, {0, 0, 0});
  const Support support = find_support(view_of({kFloor}, T_world_camera), kCamera, T_world_camera, {0.15});
  ASSERT_TRUE(support);
  EXPECT_NEAR(support.point_world.z(), 0.0, 0.002);
}

TEST(Placement, KeepsClearOfWhatStandsOnTheTable) {
  const Eigen::Isometry3d T_world_camera = looking({0, -1.2, 1.6}, {0, 0, 0.7});
  const Box mug{{-0.05, -0.05, 0.73}, {0.05, 0.05, 0.83}};
  const Box book{{0.2, -0.2, 0.73}, {0.4, 0.1, 0.76}};
  const double radius_m = 0.1;
  const Support support =
      find_support(view_of({kFloor, kTable, mug, book}, T_world_camera), kCamera, T_world_camera, {radius_m});
  ASSERT_TRUE(support);
  EXPECT_NEAR(support.point_world.z(), 0.73, 0.005);
  for (const Box& thing : {mug, book}) {
    const Eigen::Vector2d p = support.point_world.head<2>();
    const Eigen::Vector2d nearest = p.cwiseMax(thing.low.head<2>()).cwiseMin(thing.high.head<2>());
    EXPECT_GT((p - nearest).norm(), radius_m);
  }
}

TEST(Placement, AWallASlopeOrASmallStoolIsNoPlace) {
  const Eigen::Isometry3d T_world_camera = looking({0, -2.0, 1.2}, {0, 0, 1.2});
  EXPECT_FALSE(
      find_support(view_of({{{-3, 0, -3}, {3, 0.1, 5}}}, T_world_camera), kCamera, T_world_camera, {0.1}));

  const Eigen::Isometry3d from_above = looking({0, -1.0, 1.4}, {0, 0, 0.5});
  const Box stool{{-0.1, -0.1, 0.4}, {0.1, 0.1, 0.45}};
  EXPECT_FALSE(find_support(view_of({stool}, from_above), kCamera, from_above, {0.15}));
  EXPECT_TRUE(find_support(view_of({stool}, from_above), kCamera, from_above, {0.03}));

  // The floor, seen by a camera whose pose has the world tilted by 25 degrees.
  const Eigen::Isometry3d tilt(Eigen::AngleAxisd(25.0 * M_PI / 180.0, Vec3::UnitX()));
  const DepthImage floor_m = view_of({kFloor}, from_above);
  EXPECT_TRUE(find_support(floor_m, kCamera, from_above, {0.1}));
  EXPECT_FALSE(find_support(floor_m, kCamera, tilt * from_above, {0.1}));
}

TEST(Placement, RidgesAreNoPlaceThoughEachStepIsSmall) {
  const Eigen::Isometry3d from_above = looking({0, -1.0, 1.7}, {0, 0, 0.73});
  std::vector<Box> boxes = {kTable};
  EXPECT_TRUE(find_support(view_of(boxes, from_above), kCamera, from_above, {0.1}));
  for (double x = -0.6; x < 0.6; x += 0.16) boxes.push_back({{x, -0.4, 0.73}, {x + 0.08, 0.4, 0.764}});
  PlacementConfig config;
  config.room_to_spare_m = 0.0;
  EXPECT_FALSE(find_support(view_of(boxes, from_above), kCamera, from_above, {0.1}, config));
  EXPECT_TRUE(find_support(view_of(boxes, from_above), kCamera, from_above, {0.025}, config));
}

TEST(Placement, NothingSeenOrNonsenseFindsNothing) {
  const Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  EXPECT_FALSE(find_support(DepthImage(320, 240), kCamera, T, {0.1}));
  EXPECT_FALSE(find_support(DepthImage{}, kCamera, T, {0.1}));
  EXPECT_FALSE(find_support(DepthImage(319, 240, 1.0F), kCamera, T, {0.1}));
  EXPECT_FALSE(find_support(DepthImage(320, 240, 1.0F), kCamera, T, {0.0}));
  EXPECT_FALSE(find_support(DepthImage(320, 240, 1.0F), kCamera, T, {std::nan("")}));
  EXPECT_FALSE(find_support(DepthImage(320, 240, 1.0F), kCamera, T, {50.0}));
  Eigen::Isometry3d broken = T;
  broken.translation().x() = std::nan("");
  EXPECT_FALSE(find_support(DepthImage(320, 240, 1.0F), kCamera, broken, {0.1}));
}

TEST(Placement, NamesTheFieldThatIsWrong) {
  EXPECT_NO_THROW(require_valid(PlacementConfig{}));
  PlacementConfig config;
  config.cell_m = 0.0;
  EXPECT_THROW(require_valid(config), Error);
  config = {};
  config.max_range_m = std::nan("");
  EXPECT_THROW(require_valid(config), Error);
}

}  // namespace
}  // namespace roomradar::placement_test
