// joint_motion_test.cpp: bodies that move at the same time never come nearer than they may, by brute force.
#include "radar/motion/joint_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <random>
#include <vector>

#include "radar/motion/proximity.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/exact_clearance.hpp"

namespace roomradar::joint_motion_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kKeep_m = 5e-4;

struct Two {
  Mesh meshes[2];
  TriangleTree trees[2];
  Eigen::Isometry3d T[2];
  RigidMotion motions[2];

  Two(const Mesh& one, const Mesh& other) : meshes{one, other} {
    for (int i = 0; i < 2; ++i) trees[i].build_by_place(meshes[i]);
  }
  [[nodiscard]] double distance_m(double time_s) const {
    return exact_clearance(meshes[0], pose_after(T[0], motions[0], time_s), meshes[1],
                           pose_after(T[1], motions[1], time_s));
  }
  /// Free time of the first body while the second one moves, too.
  FreeTime free_time(double duration_s) {
    const SceneTree scene{{&trees[1], T[1]}, SurfaceKind::kObject};
    const TreeStates states{{}, {motions[1]}};
    return roomradar::free_time({{&trees[0], T[0]}, motions[0]}, duration_s, kKeep_m, {{&scene, 1}, {}}, 0,
                                states);
  }
};

TEST(JointMotion, NoFreeTimeOfTwoMovingBodiesIsTooLong) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double size) {
    return Vec3(size * unit(random), size * unit(random), size * unit(random));
  };
  int stopped = 0, tested = 0;
  for (const Mesh& mesh : {shapes::box({0.2F, 0.1F, 0.05F}), shapes::box({0.4F, 0.004F, 0.004F}),
                           shapes::torus(12, 6, 0.1F, 0.03F, 0.01F)}) {
    Two two(mesh, shapes::torus(16, 8, 0.2F, 0.05F, 0.02F));
    for (int i = 0; i < 80; ++i) {
      for (int k = 0; k < 2; ++k) {
        two.T[k] = Eigen::Isometry3d(Eigen::Translation3d(vector(0.3)));
        two.T[k].rotate(Eigen::AngleAxisd(3.0 * unit(random), vector(1.0).normalized()));
        const double spin_rad_s = (i + k) % 3 == 0 ? 0.0 : 20.0;
        two.motions[k] = {vector(2.0), vector(spin_rad_s), vector(0.05)};
      }
      if (i % 4 == 0) two.motions[1].angular_rad_s = two.motions[0].angular_rad_s;  // turn alike
      const double from_m = two.distance_m(0.0);
      if (from_m < 1e-3) continue;
      const FreeTime free = two.free_time(0.3);
      ASSERT_GT(free.free_s, 0.0);
      ++tested;
      stopped += free.free_s < 0.3;
      for (int k = 1; k <= 12; ++k)
        ASSERT_GE(two.distance_m(free.free_s * k / 12.0), std::min(kKeep_m, 0.5 * from_m) - 1e-7) << i;
    }
  }
  EXPECT_GT(tested, 100);
  EXPECT_GT(stopped, 40);
}

TEST(JointMotion, NoFreeTimeOfTwoThatNearlyTouchIsTooLong) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double size) {
    return Vec3(size * unit(random), size * unit(random), size * unit(random));
  };
  int stopped = 0;
  for (const Mesh& mesh : {shapes::box({0.2F, 0.1F, 0.05F}), shapes::box({0.4F, 0.02F, 0.004F})}) {
    Two two(mesh, shapes::box({0.3F, 0.2F, 0.1F}));
    for (int i = 0; i < 60; ++i) {
      for (int k = 0; k < 2; ++k) {
        two.T[k].setIdentity();
        two.T[k].rotate(Eigen::AngleAxisd(3.0 * unit(random), vector(1.0).normalized()));
        two.motions[k] = {vector(0.3), vector((i + k) % 3 == 0 ? 0.0 : 15.0), vector(0.05)};
      }
      const Vec3 way = vector(1.0).normalized();
      const double gap_m = std::pow(10.0, -3.0 - 1.5 * (1.0 + unit(random)));  // 1 mm to 1 um
      double apart_m = 0.5, step_m = 0.25;
      for (; step_m > 1e-8; step_m *= 0.5) {
        two.T[0].translation() = apart_m * way;
        apart_m += two.distance_m(0.0) > gap_m ? -step_m : step_m;
      }
      const double from_m = two.distance_m(0.0);
      if (!(from_m > 0.0)) continue;
      const FreeTime free = two.free_time(0.1);
      stopped += free.free_s < 0.1;
      for (int k = 1; k <= 24; ++k)
        ASSERT_GE(two.distance_m(free.free_s * k / 24.0), std::min(kKeep_m, 0.5 * from_m) - 1e-9) << i;
    }
  }
  EXPECT_GT(stopped, 60);
}

TEST(JointMotion, AnEdgeMayRockOnAnother) {
  // Two boxes stand on edges, one on the other, crosswise. The upper one turns about the lower one's edge.
  Two two(shapes::box({0.1F, 0.1F, 0.1F}), shapes::box({0.1F, 0.1F, 0.1F}));
  constexpr double kGap_m = 1e-5, kSpin_rad_s = 10.0;
  const double half_diagonal_m = 0.05 * std::sqrt(2.0);
  two.T[1] = Eigen::AngleAxisd(M_PI / 4, Vec3::UnitX());
  two.T[0] = Eigen::Translation3d(0.0, 0.0, 2.0 * half_diagonal_m + kGap_m) *
             Eigen::AngleAxisd(M_PI / 4, Vec3::UnitY());
  two.motions[0] = {kSpin_rad_s * Vec3::UnitX().cross(Vec3(0.0, 0.0, half_diagonal_m)),
                    kSpin_rad_s * Vec3::UnitX(), Vec3::Zero()};
  two.motions[1] = {};
  ASSERT_NEAR(two.distance_m(0.0), kGap_m, 1e-8);
  const FreeTime free = two.free_time(0.1);
  const double by_corners_s = 0.5 * kGap_m / (kSpin_rad_s * 0.05);
  EXPECT_GT(free.free_s, 20.0 * by_corners_s) << "the ends of its edge pass the level of the other edge";
  EXPECT_GE(two.distance_m(free.free_s), 0.5 * kGap_m - 1e-9);
}

TEST(JointMotion, BodiesThatMoveAlikeAreFreeForAllOfTheTime) {
  Two two(shapes::box({0.1F, 0.1F, 0.1F}), shapes::box({0.1F, 0.1F, 0.1F}));
  two.T[0] = Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.101));
  two.T[1].setIdentity();
  two.motions[0].linear_m_s = two.motions[1].linear_m_s = {3.0, -1.0, 2.0};
  EXPECT_EQ(two.free_time(0.5).free_s, 0.5);
}

TEST(JointMotion, ASpinningCubeHitsWhatRestsBesideItsFace) {
  // Relative to the cube, the small box begins to move along the face: only its acceleration brings it
  // nearer.
  Two two(shapes::box({0.004F, 0.004F, 0.004F}), shapes::box({0.2F, 0.2F, 0.2F}));
  two.T[0] = Eigen::Isometry3d(Eigen::Translation3d(0.105, 0.0, 0.0));  // 3 mm beside the face
  two.T[1].setIdentity();
  for (const double drift_mps : {0.0, 3.0}) {  // both may also drift
    two.motions[0].linear_m_s = two.motions[1].linear_m_s = {0.0, drift_mps, 0.0};
    two.motions[1].angular_rad_s = {0.0, 0.0, 20.0};
    const double hits_s = std::acos(0.1 / 0.103) / 20.0;  // the face, 0.1 / cos(turn) away, reaches 0.103 m
    const FreeTime free = two.free_time(0.1);
    EXPECT_LT(free.free_s, hits_s);
    EXPECT_GT(free.free_s, 0.2 * hits_s);
  }
}

/// Boxes of 0.1 m along x that move along it; the least index of a pair tests it.
struct Row {
  std::vector<Mesh> meshes;
  std::vector<TriangleTree> trees;
  std::vector<Eigen::Isometry3d> T;
  std::vector<JointMover> movers;
  std::atomic<int> queries = 0;

  /// @param x_m, speed_mps  per box
  Row(const std::vector<double>& x_m, const std::vector<double>& speed_mps, double duration_s)
      : meshes(x_m.size(), shapes::box({0.1F, 0.1F, 0.1F})), trees(x_m.size()), T(x_m.size()) {
    for (std::size_t i = 0; i < x_m.size(); ++i) {
      trees[i].build_by_place(meshes[i]);
      T[i] = Eigen::Isometry3d(Eigen::Translation3d(x_m[i], 0.0, 0.0));
      RigidMotion motion;
      motion.linear_m_s = {speed_mps[i], 0.0, 0.0};
      movers.push_back(
          {.T_world_object = &T[i],
           .motion = motion,
           .duration_s = duration_s,
           .path = {T[i].translation(), 0.1 + std::abs(speed_mps[i]) * duration_s},
           .free_time = [this, i](double left_s) { return free_time(i, left_s, kNoMover); },
           .free_time_beside = [this, i](std::size_t stopped,
                                         double left_s) { return free_time(i, left_s, stopped).time.free_s; },
           .limited_by = {}});
    }
  }
  /// @param only  the other box to test; kNoMover: all whose turn it is
  JointMover::Free free_time(std::size_t i, double duration_s, std::size_t only) {
    ++queries;
    std::vector<SceneTree> scene;
    TreeStates states{std::vector<bool>(T.size()), std::vector<RigidMotion>(T.size())};
    for (std::size_t k = 0; k < T.size(); ++k) {
      scene.push_back({{&trees[k], T[k]}, SurfaceKind::kObject});
      const bool is_moving = !movers[k].has_stopped;
      states.left_out[k] = k == i || (only == kNoMover ? is_moving && k < i : k != only);
      if (is_moving) states.motions[k] = movers[k].motion;
    }
    const FreeTime free = roomradar::free_time({{&trees[i], T[i]}, movers[i].motion}, duration_s, kKeep_m,
                                               {scene, {}}, 0, states);
    return {free, free.limit.kind == SurfaceKind::kNothing ? kNoMover : free.limit.tree};
  }
  [[nodiscard]] double gap_m(std::size_t i) const {
    return T[i + 1].translation().x() - T[i].translation().x() - 0.1;
  }
};

TEST(JointMotion, TwoThatMeetStopTogetherWhereTheyMeet) {
  Row row({-0.2, 0.2}, {2.0, -1.0}, 1.0);
  TreeInstance seen;
  const std::array<TreeInstance*, 1> seen_as = {&seen};
  row.movers[0].seen_as = seen_as;
  move_to_contact(row.movers);
  EXPECT_NEAR(row.movers[0].gone_s, (0.3 - kKeep_m) / 3.0, 1e-3);
  EXPECT_EQ(row.movers[1].gone_s, row.movers[0].gone_s);
  EXPECT_EQ(seen.T_world_mesh.matrix(), row.T[0].matrix());
  EXPECT_NEAR(row.T[0].translation().x(), -0.2 + 2.0 * row.movers[0].gone_s, 1e-12);
  EXPECT_NEAR(row.T[1].translation().x(), 0.2 - row.movers[1].gone_s, 1e-12);
  EXPECT_EQ(row.movers[0].limited_by.kind, SurfaceKind::kObject);
  EXPECT_EQ(row.movers[1].limited_by.kind, SurfaceKind::kNothing);
}

TEST(JointMotion, OthersMoveOnUntilTheyReachTheTwoThatMet) {
  // The first two meet at x = 0; the third follows and reaches them at rest; the fourth leaves.
  Row row({-0.2, 0.2, 0.5, 1.0}, {2.0, -2.0, -1.0, 1.0}, 1.0);
  move_to_contact(row.movers);
  EXPECT_NEAR(row.movers[0].gone_s, (0.3 - kKeep_m) / 4.0, 1e-3);
  EXPECT_EQ(row.movers[1].gone_s, row.movers[0].gone_s);
  EXPECT_NEAR(row.movers[2].gone_s, 0.35, 5e-3);
  EXPECT_EQ(row.movers[2].limited_by.kind, SurfaceKind::kObject);
  EXPECT_EQ(row.movers[3].gone_s, 1.0);
  for (const std::size_t i : {0, 1}) {
    EXPECT_GE(row.gap_m(i), 0.5 * kKeep_m) << i;  // the second stop began within 2 keep_m
    EXPECT_LT(row.gap_m(i), 5e-3) << i;
  }
}

TEST(JointMotion, ABodyWhoseTimeHasEndedIsAnObstacleAtRest) {
  Row row({0.0, 0.3}, {1.0, 1.0}, 1.0);
  row.movers[1].duration_s = 0.25;
  move_to_contact(row.movers);
  EXPECT_EQ(row.movers[1].gone_s, 0.25);
  EXPECT_NEAR(row.movers[0].gone_s, 0.45, 5e-3);
  EXPECT_GE(row.gap_m(0), 0.5 * kKeep_m);
}

TEST(JointMotion, WhatIsFarFromThoseThatMetIsNotQueriedAgain) {
  Row row({-0.2, 0.2, 5.0}, {2.0, -2.0, -1.0}, 0.2);
  move_to_contact(row.movers);
  EXPECT_EQ(row.movers[2].gone_s, 0.2);
  const int before = row.queries;
  Row two({-0.2, 0.2}, {2.0, -2.0}, 0.2);
  move_to_contact(two.movers);
  EXPECT_EQ(before, two.queries + 1);
}

TEST(JointMotion, AWorkerAndOtherSetsChangeNothing) {
  const std::vector<double> x_m = {-0.2, 0.2, 0.5, 1.0, 1.3, 1.7, 2.2}, mps = {2, -2, -1, 1, -3, 0.5, -1};
  const std::vector<double> few_x_m = {0.0, 0.3, 0.9}, few_mps = {1.0, 0.0, -2.0};
  Row alone(x_m, mps, 1.0), shared(x_m, mps, 1.0), few_alone(few_x_m, few_mps, 1.0),
      few(few_x_m, few_mps, 1.0);
  move_to_contact(alone.movers);
  move_to_contact(few_alone.movers);
  WorkerThread worker;
  const std::array<std::span<JointMover>, 2> sets = {shared.movers, few.movers};
  move_to_contact(sets, &worker);
  const auto expect_same = [](const Row& row, const Row& expected) {
    EXPECT_EQ(row.queries, expected.queries);
    for (std::size_t i = 0; i < row.T.size(); ++i) {
      EXPECT_EQ(row.movers[i].gone_s, expected.movers[i].gone_s) << i;
      EXPECT_EQ(row.T[i].matrix(), expected.T[i].matrix()) << i;
    }
  };
  expect_same(shared, alone);
  expect_same(few, few_alone);
}

TEST(JointMotion, PathsThatOverlapAreOneSet) {
  const std::vector<PathBall> paths = {
      {{0, 0, 0}, 1.0}, {{5, 0, 0}, 1.0}, {{1.5, 0, 0}, 0.6}, {{0, 0, 0}, 0.0}, {{3.0, 0, 0}, 1.0}};
  const std::vector<std::vector<std::size_t>> sets = sets_that_meet(paths);
  ASSERT_EQ(sets.size(), 2U);
  std::vector<std::vector<std::size_t>> sorted = sets;
  std::sort(sorted.begin(), sorted.end());
  EXPECT_EQ(sorted[0], (std::vector<std::size_t>{0, 2, 4}));
  EXPECT_EQ(sorted[1], (std::vector<std::size_t>{1}));
  EXPECT_TRUE(sets_that_meet({}).empty());
}

}  // namespace
}  // namespace roomradar::joint_motion_test
