// recorded_prior_test.cpp: recorded poses predict and constrain the motion; depth verifies them.
#include <gtest/gtest.h>

#include <cmath>

#include "mapping/odometry/odometry.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "tests/support/noisy_room.hpp"

namespace roomradar::recorded_prior_test {
namespace {

using test::frame_at, test::on_path;

constexpr int kFrames = 40;

OdometryConfig with_prior() {
  OdometryConfig config;
  config.use_recorded_poses = true;
  return config;
}

/// Pose of the recording's world in that of the room: any.
Eigen::Isometry3d recorded_world() {
  return Eigen::Translation3d(7.0, -3.0, 1.0) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
}

Eigen::Isometry3d truth(int i) { return on_path(0, 60).inverse() * on_path(i, 60); }

/// Largest distance of tracked positions from the truth, from frame `first` on.
template <typename Record>
double worst_error_m(Odometry& odometry, const Record& record, int first = 0) {
  double worst_m = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = frame_at(on_path(i, 60), i);
    frame.T_world_camera = record(i, recorded_world() * on_path(i, 60));
    const Tracking tracking = odometry.track(frame);
    EXPECT_TRUE(tracking) << i;
    if (i < first) continue;
    worst_m = std::max(worst_m, (tracking.T_world_camera.translation() - truth(i).translation()).norm());
  }
  return worst_m;
}

TEST(RecordedPrior, ConstrainsWhatABareWallDoesNot) {
  // Depth constrains the distance and two tilts; the motion along the wall is recorded.
  const test::Scene wall = test::plane({0, 1, 0}, 2.5);
  const Eigen::Isometry3d start = test::looking_at({0, 0.5, 1.2}, {0, 2.5, 1.2});
  const auto moved = [&](int i) { return start * Eigen::Translation3d(0.01 * i, 0.004 * i, -0.01 * i); };
  Odometry odometry(with_prior());
  Odometry without;
  for (int i = 0; i < kFrames; ++i) {
    Frame frame = frame_at(moved(i), i, wall);
    frame.colour.resize(0, 0);
    frame.T_world_camera = recorded_world() * moved(i);
    const Tracking tracking = odometry.track(frame);
    ASSERT_TRUE(tracking) << i;
    EXPECT_LT((tracking.T_world_camera.translation() - (start.inverse() * moved(i)).translation()).norm(),
              0.003)
        << i;
    EXPECT_EQ(without.track(frame).status, i > 0 ? TrackStatus::kDegenerate : TrackStatus::kTracked) << i;
  }
  EXPECT_EQ(odometry.state().prior.contradicted, 0);
  EXPECT_GE(odometry.state().prior.used, kFrames - 1);
}

TEST(RecordedPrior, AJumpOfTheRecordedWorldMovesNothing) {
  Odometry odometry(with_prior());
  const Eigen::Isometry3d jump(Eigen::Translation3d(0.12, 0.2, -0.1));
  const double worst_m =
      worst_error_m(odometry, [&](int i, const Eigen::Isometry3d& T) { return i < 20 ? T : jump * T; });
  EXPECT_LT(worst_m, 0.01);
  EXPECT_GE(odometry.state().prior.contradicted, 1);
  EXPECT_LE(odometry.state().prior.contradicted, 3);
}

TEST(RecordedPrior, AnAbsurdPoseCostsNothing) {
  Odometry odometry(with_prior());
  const double worst_m = worst_error_m(odometry, [&](int i, Eigen::Isometry3d T) {
    if (i == 15) T.translation().z() = 1e12;
    return T;
  });
  EXPECT_LT(worst_m, 0.01);
}

TEST(RecordedPrior, ExactPosesAreFollowedExactly) {
  Odometry exact(with_prior());
  EXPECT_LT(worst_error_m(exact, [](int, const Eigen::Isometry3d& T) { return T; }), 0.004);
}

TEST(RecordedPrior, FramesWithoutAPoseAreTrackedAsEver) {
  Odometry odometry(with_prior());
  const double worst_m = worst_error_m(odometry, [](int i, const Eigen::Isometry3d& T) {
    return i % 3 == 0 ? std::optional(T) : std::nullopt;
  });
  EXPECT_LT(worst_m, 0.015);  // while turning round, the camera counts as stationary for 1 cm
}

TEST(RecordedPrior, NoisyPosesAreNotFollowed) {
  constexpr double kNoise_m = 0.03;
  const auto noisy = [](int i, Eigen::Isometry3d T) {
    for (int k = 0; k < 3; ++k) T.translation()(k) += kNoise_m * gaussian(hash_of(7, i, k));
    return T;
  };
  Odometry odometry(with_prior());
  // Three poses tell that they are noisy. The first defines the world, and is as noisy as the others.
  EXPECT_LT(worst_error_m(odometry, noisy, 3), 0.02);
  EXPECT_GT(odometry.state().prior.jitter_m, 0.5 * kNoise_m);
  EXPECT_GE(odometry.state().prior.sigma_m, odometry.state().prior.jitter_m);
}

TEST(RecordedPrior, JitterIsWhatNoHandDoes) {
  MotionPrior prior;
  // Shaken by hand: 3 cm at 2 Hz, 4.7 m/s^2.
  for (int i = 0; i < 60; ++i) {
    const double t_s = i / 30.0;
    note_recorded(prior, t_s, Eigen::Isometry3d(Eigen::Translation3d(0.03 * std::sin(12.57 * t_s), t_s, 0)));
  }
  EXPECT_EQ(prior.jitter_m, 0.0);
  // A jump counts as none, nor do equal stamps or NaN.
  note_recorded(prior, 2.0, Eigen::Isometry3d(Eigen::Translation3d(5, 0, 0)));
  note_recorded(prior, 2.0, Eigen::Isometry3d(Eigen::Translation3d(5, 0.1, 0)));
  note_recorded(prior, 2.1, Eigen::Isometry3d(Eigen::Translation3d(NAN, 0, 0)));
  EXPECT_EQ(prior.jitter_m, 0.0);
  // Seconds between frames leave room for any motion.
  MotionPrior slow;
  for (int i = 0; i < 20; ++i)
    note_recorded(slow, i, Eigen::Isometry3d(Eigen::Translation3d(0.2 * (i % 2), 0, 0)));
  EXPECT_EQ(slow.jitter_m, 0.0);
}

}  // namespace
}  // namespace roomradar::recorded_prior_test
