// sim_motion_test.cpp: camera paths and moving objects: smooth, bounded, deterministic, at the right
// positions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/sensor/movers.hpp"

namespace roomradar::sim_motion_test {
namespace {

using Eigen::Vector3d;

class SimPath : public testing::TestWithParam<std::string> {};

TEST_P(SimPath, ScanIsSmoothSlowClearAndComesBack) {
  const Room room = make_room(GetParam());
  constexpr double kDuration_s = 24.0, kStep_s = 0.005;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const CameraPath path = plan_camera_path(room, CameraPathKind::kScan, seed, kDuration_s);
    double fastest_m_s = 0.0, fastest_turn_deg_s = 0.0, clear_m = 10.0, sharpest_m_s3 = 0.0, length_m = 0.0;
    Vector3d velocity_before, acceleration_before;
    for (int i = 0; i * kStep_s < kDuration_s; ++i) {
      const Eigen::Isometry3d a = T_world_camera_at(path, i * kStep_s),
                              b = T_world_camera_at(path, (i + 1) * kStep_s);
      const Vector3d velocity = (b.translation() - a.translation()) / kStep_s;
      const Vector3d acceleration =
          i == 0 ? Vector3d::Zero() : Vector3d((velocity - velocity_before) / kStep_s);
      if (i > 1)
        sharpest_m_s3 = std::max(sharpest_m_s3, (acceleration - acceleration_before).norm() / kStep_s);
      velocity_before = velocity;
      acceleration_before = acceleration;
      fastest_m_s = std::max(fastest_m_s, velocity.norm());
      length_m += velocity.norm() * kStep_s;
      const double turn_rad = Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
      fastest_turn_deg_s = std::max(fastest_turn_deg_s, turn_rad / kStep_s * 180.0 / std::numbers::pi);
      clear_m = std::min(clear_m, signed_distance_m(room, a.translation()));
    }
    EXPECT_LT(fastest_m_s, 0.6) << seed;
    EXPECT_GT(length_m / kDuration_s, 0.3) << seed;
    EXPECT_LT(fastest_turn_deg_s, 40.0) << seed;
    EXPECT_GT(clear_m, 0.5) << seed;
    EXPECT_LT(sharpest_m_s3, 40.0) << seed << ": a jump in the acceleration";
    const double gap_m =
        (T_world_camera_at(path, kDuration_s).translation() - T_world_camera_at(path, 0.0).translation())
            .norm();
    EXPECT_LT(gap_m, 0.3) << seed;
  }
}

TEST_P(SimPath, ViewerStandsClearAndSeesTheFocus) {
  const Room room = make_room(GetParam());
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const CameraPath path = plan_camera_path(room, CameraPathKind::kView, seed, 10.0);
    Vector3d before = T_world_camera_at(path, 0.0).translation();
    for (double t_s = 0.0; t_s < 10.0; t_s += 0.1) {
      const Eigen::Isometry3d T_world_camera = T_world_camera_at(path, t_s);
      const Vector3d focus_camera = T_world_camera.inverse() * room.focus_world;
      EXPECT_GT(focus_camera.z(), 1.1);
      EXPECT_LT(focus_camera.norm(), 1.9);
      EXPECT_LT(focus_camera.head<2>().norm() / focus_camera.z(), 0.1)
          << "the focus is near the image's middle";
      EXPECT_GT(signed_distance_m(room, T_world_camera.translation()), 0.5);
      const auto hit =
          cast_ray(room, T_world_camera.translation(), room.focus_world - T_world_camera.translation());
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->range_m, 1.0, 1e-6) << "something hides the focus";
      EXPECT_LT((T_world_camera.translation() - before).norm(), 0.02) << "a hand's sway, not a walk";
      before = T_world_camera.translation();
      EXPECT_NEAR(T_world_camera.linear().determinant(), 1.0, 1e-12);
      EXPECT_LT((T_world_camera.linear() * T_world_camera.linear().transpose() - Eigen::Matrix3d::Identity())
                    .norm(),
                1e-12);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(EachRoom, SimPath, testing::ValuesIn(room_names()));

TEST(SimPathBySeed, SeedsDifferAndRepeat) {
  const Room room = make_room("table");
  const auto at_2_s = [&](std::uint64_t seed) {
    return T_world_camera_at(plan_camera_path(room, CameraPathKind::kScan, seed, 20.0), 2.0).matrix().eval();
  };
  EXPECT_EQ(at_2_s(4), at_2_s(4));
  EXPECT_GT((at_2_s(4) - at_2_s(5)).norm(), 0.1);
}

class SimMover : public testing::TestWithParam<MoverKind> {};

TEST_P(SimMover, MovesSmoothlyAsOneBodyWithAMaterialForEachPart) {
  const Room room = make_room("table");
  const Mover mover = plan_mover(GetParam(), room, room.focus_world + Vector3d(0, -1.2, 0.8), 3);
  constexpr double kStep_s = 0.005;
  std::vector<Solid> before, now, after;
  append_solids(mover, 0.0, before);
  append_solids(mover, kStep_s, now);
  ASSERT_EQ(before.size(), mover.materials.size());
  double farthest_m = 0.0;
  for (int i = 2; i < 3000; ++i) {
    after.clear();
    append_solids(mover, i * kStep_s, after);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t part = 0; part < now.size(); ++part) {
      const Vector3d a = before[part].T_world_solid.translation(), b = now[part].T_world_solid.translation(),
                     c = after[part].T_world_solid.translation();
      EXPECT_LT((c - b).norm() / kStep_s, 3.0);                         // m/s
      EXPECT_LT((c - 2.0 * b + a).norm() / (kStep_s * kStep_s), 25.0);  // m/s2
      farthest_m = std::max(farthest_m, (c - mover.to_world).norm());
      EXPECT_GT(c.z(), 0.0);
    }
    before = now;
    now = after;
  }
  EXPECT_GT(farthest_m, 0.4) << "it does move";
}

INSTANTIATE_TEST_SUITE_P(EachKind, SimMover,
                         testing::Values(MoverKind::kHand, MoverKind::kBall, MoverKind::kPerson));

TEST(SimPace, WhoWaitsStandsStillForTwoSecondsAndWhoLeavesIsGoneInTheEnd) {
  const Room room = make_room("table");
  const auto middle_at = [&](Pace pace, double t_s) {
    const Mover mover = plan_mover(MoverKind::kPerson, room, {0, 0, 0}, 3, pace, 10.0);
    std::vector<Solid> solids;
    append_solids(mover, t_s, solids);
    return Vector3d(solids.back().T_world_solid.translation());
  };
  const auto path_length_m = [&](Pace pace, double from_s, double to_s) {
    return (middle_at(pace, to_s) - middle_at(pace, from_s)).norm();
  };
  EXPECT_LT(path_length_m(Pace::kWaits, 0.1, 1.9), 1e-9);
  EXPECT_GT(path_length_m(Pace::kWaits, 2.0, 4.0), 0.1);
  EXPECT_LT(path_length_m(Pace::kWaits, 4.1, 5.9), 1e-9);
  EXPECT_NEAR(path_length_m(Pace::kSlow, 0.0, 3.0), path_length_m(Pace::kSteady, 0.0, 1.0), 1e-9);
  EXPECT_LT(path_length_m(Pace::kLeaves, 0.0, 4.9), 1e-9);
  const Vector3d last = middle_at(Pace::kLeaves, 10.0);
  EXPECT_GT((last - last.cwiseMax(room.interior_min_world).cwiseMin(room.interior_max_world)).norm(), 1.0);
  for (double t_s = 0.0; t_s < 10.0; t_s += 0.01)
    EXPECT_LT(path_length_m(Pace::kLeaves, t_s, t_s + 0.01), 0.03) << "at " << t_s << " s";
}

TEST(SimBall, RollsWithoutSlippingAndTouchesTheTable) {
  const Room room = make_room("table");
  const Mover mover = plan_mover(MoverKind::kBall, room, {0, 0, 0}, 3);
  std::vector<Solid> a, b;
  append_solids(mover, 1.0, a);
  append_solids(mover, 1.001, b);
  EXPECT_NEAR(signed_distance_m(room, a[0].T_world_solid.translation()), mover.radius_m, 1e-9);
  const double moved_m = (b[0].T_world_solid.translation() - a[0].T_world_solid.translation()).norm();
  const double turned_rad =
      Eigen::AngleAxisd(a[0].T_world_solid.linear().transpose() * b[0].T_world_solid.linear()).angle();
  ASSERT_GT(moved_m, 1e-5);
  EXPECT_NEAR(turned_rad * mover.radius_m, moved_m, 1e-6);
}

}  // namespace
}  // namespace roomradar::sim_motion_test
