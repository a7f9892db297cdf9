// contact_queries_test.cpp: which closest features are queried again after bodies have moved.
#include "app/physics/contact_queries.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace roomradar::contact_queries_test {
namespace {

using Vec3 = Eigen::Vector3d;

/// Two balls of 5 cm on a floor at z = 0, with analytic features and counted queries. Each body's scene has
/// the floor as tree 0 and the other ball as tree 1.
class TwoBalls : public ::testing::Test {
 protected:
  static constexpr double kRadius_m = 0.05;

  TwoBalls() {
    for (std::size_t i = 0; i < 2; ++i) {
      probes_[i].near = [this, i](const Eigen::Isometry3d& T, double reach_m, SurfaceKindMask,
                                  const TreeStates& trees, std::vector<ClosestPoint>& points) {
        points.clear();
        ++queries_[i];
        const Vec3 at = T.translation(), other = bodies_[1 - i].T_world_object.translation();
        const Vec3 from_other = (at - other).normalized();
        const double over_floor_m = at.z() - kRadius_m, apart_m = (at - other).norm() - 2.0 * kRadius_m;
        if (!trees.is_left_out(0) && over_floor_m <= reach_m)
          points.push_back({Vec3(at.x(), at.y(), 0.0), Vec3::UnitZ(), over_floor_m, SurfaceKind::kStatic, 0});
        if (!trees.is_left_out(1) && apart_m <= reach_m)
          points.push_back({other + kRadius_m * from_other, from_other, apart_m, SurfaceKind::kObject, 1});
        return i == crossing_ ? bit_of(SurfaceKind::kStatic) : SurfaceKindMask{0};
      };
      moving_[i].dt_s = moving_[i].left_s = 1.0;
      moving_[i].member_of_tree = {kNoOther, 1 - i};
      bodies_[i].mass.radius_m = kRadius_m;
      bodies_[i].T_world_object.translation() = Vec3(0.1005 * static_cast<double>(i), 0.0, 0.0505);
    }
    system_.upwards = {0, 1};
  }
  void query() {
    queries_ = {};
    static_cast<void>(query_contacts(moving_, config_, system_));
  }
  [[nodiscard]] std::size_t features() const { return moving_[0].near.size() + moving_[1].near.size(); }

  PhysicsConfig config_;
  std::array<Body, 2> bodies_;
  std::array<CollisionQueries, 2> probes_;
  std::array<AdvancedBody, 2> advanced_{
      {{.body = &bodies_[0], .probe = &probes_[0]}, {.body = &bodies_[1], .probe = &probes_[1]}}};
  std::array<MovingBody, 2> moving_{{{.in = advanced_[0]}, {.in = advanced_[1]}}};
  std::array<int, 2> queries_{};
  std::size_t crossing_ = kNoOther;  ///< the ball that a wall crosses
  ContactSystem system_;
};

TEST_F(TwoBalls, EachPairIsQueriedOnceAndKeptWhileNothingMoves) {
  query();
  EXPECT_EQ(queries_, (std::array{1, 1}));
  EXPECT_EQ(features(), 3U);  // two on the floor, one between the balls
  query();
  EXPECT_EQ(queries_, (std::array{0, 0}));
  EXPECT_EQ(features(), 3U);
  bodies_[0].T_world_object.translation().z() += 0.2 * config_.contact_margin_m;  // too little
  query();
  EXPECT_EQ(queries_, (std::array{0, 0}));
}

TEST_F(TwoBalls, WhatMovedIsQueriedAgainAlsoForTheOther) {
  query();
  bodies_[1].T_world_object.translation().x() += 0.4 * config_.contact_margin_m;
  query();
  EXPECT_EQ(queries_, (std::array{1, 1}));  // the lower one only against the upper one
  EXPECT_EQ(features(), 3U);
  for (const MovingBody& moving : moving_)
    for (const ClosestPoint& p : moving.near)
      EXPECT_TRUE(p.tree == 0 || std::abs(p.gap_m - 0.0009) < 1e-12) << p.gap_m;
  bodies_[1].T_world_object.translation().x() += 0.01;
  query();
  EXPECT_EQ(features(), 2U);  // they are apart
}

TEST_F(TwoBalls, APairIsNotLostWhenASurfaceCrossesTheLowerOne) {
  crossing_ = 0;
  query();
  EXPECT_TRUE(moving_[0].crosses);
  EXPECT_EQ(moving_[1].near.size(), 2U);  // floor and the crossed ball
  crossing_ = kNoOther;
  moving_[0].crosses = false;
  query();
  EXPECT_EQ(features(), 3U);
}

TEST_F(TwoBalls, APairIsNotLostWhenOneOfThemStops) {
  query();
  moving_[0].left_s = 0.0;  // the one that listed the pair
  query();
  EXPECT_EQ(queries_, (std::array{0, 1}));
  EXPECT_EQ(moving_[1].near.size(), 2U);  // floor and the stopped ball
  query();
  EXPECT_EQ(queries_, (std::array{0, 0}));
  EXPECT_EQ(moving_[1].near.size(), 2U);
}

}  // namespace
}  // namespace roomradar::contact_queries_test
