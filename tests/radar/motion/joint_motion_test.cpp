// joint_motion_test.cpp: bodies that move at the same time never come nearer than they may, by brute force.
#include "radar/motion/joint_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
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
  ProximityQuery field;

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
    return field.free_time({&trees[0], T[0]}, motions[0], duration_s, kKeep_m, {{&scene, 1}, {}}, 0, states);
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

/// Two boxes 0.3 m apart that approach each other along x.
TEST(JointMotion, TwoThatMeetStopTogetherWhereTheyMeet) {
  Two two(shapes::box({0.1F, 0.1F, 0.1F}), shapes::box({0.1F, 0.1F, 0.1F}));
  two.T[0] = Eigen::Isometry3d(Eigen::Translation3d(-0.2, 0.0, 0.0));
  two.T[1] = Eigen::Isometry3d(Eigen::Translation3d(0.2, 0.0, 0.0));
  two.motions[0].linear_m_s = {2.0, 0.0, 0.0};
  two.motions[1].linear_m_s = {-1.0, 0.0, 0.0};
  int moves = 0;
  const std::function<void()> count = [&] { ++moves; };
  std::vector<JointMover> movers;
  movers.push_back({.T_world_object = &two.T[0],
                    .motion = two.motions[0],
                    .free_time = [&](double duration_s) { return two.free_time(duration_s); },
                    .moved = &count,
                    .limited_by = {}});
  movers.push_back({.T_world_object = &two.T[1],
                    .motion = two.motions[1],
                    .free_time =
                        [](double duration_s) {
                          return FreeTime{duration_s, {}};
                        },
                    .moved = nullptr,
                    .limited_by = {}});
  const double gone_s = move_to_contact(movers, 1.0);
  EXPECT_NEAR(gone_s, (0.3 - kKeep_m) / 3.0, 1e-3);
  EXPECT_GT(moves, 0);
  EXPECT_NEAR(two.T[0].translation().x(), -0.2 + 2.0 * gone_s, 1e-12);
  EXPECT_NEAR(two.T[1].translation().x(), 0.2 - gone_s, 1e-12);
  EXPECT_EQ(movers[0].limited_by.kind, SurfaceKind::kObject);
  EXPECT_EQ(movers[1].limited_by.kind, SurfaceKind::kNothing);
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
