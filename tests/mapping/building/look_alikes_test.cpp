// look_alikes_test.cpp: the motion from a room to its twin, from joins that were refused.
#include "mapping/building/join_choice.hpp"

#include <gtest/gtest.h>

namespace roomradar::look_alikes_test {
namespace {

Eigen::Isometry3d pose(double x_m, double z_m, double yaw_rad = 0.0) {
  Eigen::Isometry3d T(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  T.translation() = Eigen::Vector3d(x_m, 0.0, z_m);
  return T;
}

/// Two submaps of `keyframes` keyframes, the second 3 m above the first and turned by 0.5 rad, and a join
/// that takes each keyframe for the one with the same number.
struct TwoStoreys {
  std::vector<PlacedSubmap> submaps{2};
  std::vector<GraphJoin> joins{{0, 1, {}}};

  explicit TwoStoreys(std::size_t keyframes) {
    for (std::size_t k = 0; k < keyframes; ++k) {
      const double x_m = 0.1 * static_cast<double>(k);
      submaps[0].T_building_keyframe.push_back(pose(x_m, 1.5));
      submaps[1].T_building_keyframe.push_back(T_above_below() * pose(x_m, 1.5));
      joins[0].join.links.push_back({k, k});
    }
  }
  static Eigen::Isometry3d T_above_below() { return pose(0.0, 3.0, 0.5); }
};

TEST(LookAlikes, MoveARoomOntoItsTwinAndBack) {
  const TwoStoreys storeys(2);
  const auto found = find_look_alikes(storeys.submaps, 0, storeys.joins);
  ASSERT_EQ(found.size(), 4U);
  const Eigen::Isometry3d T_above_below = TwoStoreys::T_above_below();
  EXPECT_TRUE(found[0].p_world.isApprox(Eigen::Vector3d(0.0, 0.0, 1.5)));
  EXPECT_TRUE(found[0].T_other_this.isApprox(T_above_below));
  EXPECT_TRUE(found[1].p_world.isApprox(T_above_below * Eigen::Vector3d(0.0, 0.0, 1.5)));
  EXPECT_TRUE(found[1].T_other_this.isApprox(T_above_below.inverse()));
  EXPECT_TRUE(found[2].p_world.isApprox(Eigen::Vector3d(0.1, 0.0, 1.5)));
}

TEST(LookAlikes, AreSpreadAlongALongJoin) {
  const TwoStoreys storeys(120);
  const auto found = find_look_alikes(storeys.submaps, 0, storeys.joins);
  ASSERT_EQ(found.size(), 24U);
  EXPECT_GT(found[22].p_world.x(), 10.0);
}

TEST(LookAlikes, AreNotAnInaccurateJoinNorInAnotherPart) {
  TwoStoreys storeys(2);
  EXPECT_TRUE(find_look_alikes(storeys.submaps, 1, storeys.joins).empty());
  storeys.submaps[1].part = 1;
  EXPECT_TRUE(find_look_alikes(storeys.submaps, 0, storeys.joins).empty());
  storeys.submaps[1] = storeys.submaps[0];
  EXPECT_TRUE(find_look_alikes(storeys.submaps, 0, storeys.joins).empty());
  EXPECT_TRUE(find_look_alikes(storeys.submaps, 0, {}).empty());
}

}  // namespace
}  // namespace roomradar::look_alikes_test
