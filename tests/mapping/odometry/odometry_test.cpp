// odometry_test.cpp: a camera tracked through rooms: exact, noisy, temporarily dark, real.
#include "mapping/odometry/odometry.hpp"

#include <gtest/gtest.h>

#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "mapping/alignment/stationary_camera.hpp"
#include "mapping/types/trajectory.hpp"
#include "tests/support/noisy_room.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::odometry_test {
namespace {

using test::dark_frame, test::frame_at, test::on_path, test::room, test::timed;

TEST(Odometry, FollowsANoisyLoopWithinMillimetres) {
  constexpr int kFrames = 60;
  Odometry odometry;
  std::vector<TimedPose> truth;
  for (int i = 0; i <= kFrames; ++i) {
    truth.push_back({i, i / 30.0, on_path(i, kFrames)});
    EXPECT_TRUE(odometry.track(frame_at(truth.back().T_world_camera, i))) << i;
  }
  const std::vector<TrackedFrame> found = odometry.optimise();
  ASSERT_EQ(found.size(), truth.size());
  for (const TrackedFrame& f : found) EXPECT_TRUE(f.trusted);
  EXPECT_LT(absolute_trajectory_error(timed(found), truth).rmse_m, 0.004);
  const Eigen::Isometry3d gap = found.front().T_world_camera.inverse() * found.back().T_world_camera;
  EXPECT_LT(gap.translation().norm(), 0.005);
  EXPECT_EQ(odometry.counts().tracked, kFrames + 1);
  EXPECT_GT(odometry.counts().keyframes, 3);
  EXPECT_EQ(static_cast<std::int64_t>(odometry.take_keyframe_database().keyframes.size()),
            odometry.counts().keyframes);
}

TEST(Odometry, StandsStillWhileThingsMoveBeforeIt) {
  Odometry odometry;
  const Eigen::Isometry3d T = on_path(0, 1);
  for (int i = 0; i < 10; ++i) {
    const double x = -0.3 + 0.05 * i;
    const test::Scene with_arm = test::nearest_of(
        room(),
        test::box(Eigen::AlignedBox3d(Eigen::Vector3d(x - 0.4, 0.7, 0.8), Eigen::Vector3d(x, 0.8, 1.2))));
    const Tracking tracking = odometry.track(frame_at(T, i, with_arm));
    EXPECT_TRUE(tracking) << i;
    EXPECT_LT(tracking.T_world_camera.translation().norm(), 1e-9) << i;
  }
}

TEST(Odometry, NearThingsMakeFewKeyframes) {
  // A doll's house, 20 to 60 cm away: in the next frame much has left the view.
  constexpr double kScale = 0.2;
  SimulatedSource source(parse_sim_spec("sim:table?frames=30&width=320&path=scan"));
  Odometry odometry;
  Eigen::Isometry3d T_first_world = Eigen::Isometry3d::Identity();
  Frame frame;
  for (int i = 0; source.next(frame).status == ReadStatus::kFrame; ++i) {
    for (float& z_m : frame.depth_m.pixels) z_m *= static_cast<float>(kScale);
    const Eigen::Isometry3d& T_world_camera = *frame.T_world_camera;
    if (i == 0) T_first_world = T_world_camera.inverse();
    const Tracking tracking = odometry.track(frame);
    ASSERT_TRUE(tracking) << i;
    const Eigen::Vector3d truth = kScale * (T_first_world * T_world_camera).translation();
    EXPECT_LT((tracking.T_world_camera.translation() - truth).norm(), 0.003) << i;
  }
  EXPECT_LE(odometry.counts().keyframes, 8);
}

TEST(Odometry, ComesBackAfterALossByKnowingThePlace) {
  constexpr int kFrames = 60, kSeen = 25, kDark = 3;
  Odometry odometry;
  for (int i = 0; i < kSeen; ++i) EXPECT_TRUE(odometry.track(frame_at(on_path(i, kFrames), i)));
  for (int i = kSeen; i < kSeen + kDark; ++i) EXPECT_FALSE(odometry.track(dark_frame(i)));
  // Resumed 15 frames back, 40 cm from the last tracked pose: too far for the motion model.
  const Eigen::Isometry3d truth = on_path(0, kFrames).inverse() * on_path(7, kFrames);
  const Tracking back = odometry.track(frame_at(on_path(7, kFrames), kSeen + kDark));
  ASSERT_TRUE(back) << to_string(back.status);
  EXPECT_LT((back.T_world_camera.translation() - truth.translation()).norm(), 0.01);
  EXPECT_EQ(odometry.counts().lost, kDark);
  EXPECT_EQ(odometry.counts().relocalised, 1);
  const std::vector<TrackedFrame> all = odometry.optimise();
  for (int i = 0; i <= kSeen + kDark; ++i) {
    EXPECT_EQ(all[static_cast<std::size_t>(i)].trusted, i < kSeen || i >= kSeen + kDark) << i;
  }
}

TEST(Odometry, AJumpThatNoHandMakesIsNotTrusted) {
  // The depth shows a camera motion of 20 cm in a thirtieth of a second, and the frame has no colour to
  // relocalise by. A Kinect that recalibrates itself causes such frames.
  Odometry odometry;
  const Eigen::Isometry3d T = on_path(0, 1);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(odometry.track(frame_at(T, i)));
  Frame jumped = frame_at(T * Eigen::Translation3d(0.2, 0.0, 0.0), 3);
  jumped.colour.resize(0, 0);
  EXPECT_FALSE(odometry.track(jumped));
  const Tracking after = odometry.track(frame_at(T, 4));
  EXPECT_TRUE(after);
  EXPECT_LT(after.T_world_camera.translation().norm(), 0.005);
}

TEST(Odometry, BeforeOneBareWallItSaysSoAndHoldsWhatItCannotSee) {
  // The camera retreats from a wall without texture: distance and two tilts are observable, the rest comes
  // from the motion model, and no such frame may be fused.
  const test::Scene wall = test::plane({0, 1, 0}, 2.5);
  const Eigen::Isometry3d start = test::looking_at({0, 0.5, 1.2}, {0, 2.5, 1.2});
  Odometry odometry;
  const auto bare_frame = [&](int i) {
    Frame frame = frame_at(start * Eigen::Translation3d(0, 0, -0.01 * i), i, wall);
    frame.colour.resize(0, 0);
    return frame;
  };
  EXPECT_TRUE(odometry.track(bare_frame(0)));
  for (int i = 1; i < 8; ++i) {
    const Tracking tracking = odometry.track(bare_frame(i));
    EXPECT_EQ(tracking.status, TrackStatus::kDegenerate) << i;
    EXPECT_EQ(tracking.unconstrained_dofs, 3) << i;
    EXPECT_NEAR(tracking.T_world_camera.translation().z(), -0.01 * i, 0.003) << i;
    EXPECT_LT(tracking.T_world_camera.translation().head<2>().norm(), 0.003) << i;
  }
  EXPECT_EQ(odometry.counts().degenerate, 7);
  const std::vector<TrackedFrame> all = odometry.optimise();
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_FALSE(all[i].trusted) << i;
}

TEST(Odometry, BeforeAPaintedWallFollowsColourThatIsLateFromTheFirstFrame) {
  // Depth does not constrain the motion along the wall, colour alone does. The camera moves in the first
  // frame already.
  constexpr double kDelay_s = 0.04, kSpeed_mps = 0.4;
  const test::Scene wall = test::plane({0, 1, 0}, 2.5);
  const Eigen::Isometry3d start = test::looking_at({-0.2, 1.0, 1.2}, {-0.2, 2.5, 1.2});
  const auto at = [&](double time_s) -> Eigen::Isometry3d {
    return start * Eigen::Translation3d(kSpeed_mps * time_s, 0, 0);
  };
  OdometryConfig config;
  config.timing = SensorTiming{.colour_delay_s = kDelay_s};
  config.estimate_timing = false;
  Odometry odometry(config);
  for (int i = 0; i < 20; ++i) {
    Frame frame = frame_at(at(i / 30.0), i, wall);
    frame.colour = frame_at(at(i / 30.0 + kDelay_s), i, wall).colour;
    const Tracking tracking = odometry.track(frame);
    EXPECT_EQ(tracking.status, TrackStatus::kTracked) << i;
    EXPECT_NEAR(tracking.T_world_camera.translation().x(), kSpeed_mps * i / 30.0, 0.005) << i;
  }
}

TEST(Odometry, BeginsWithTheFirstFrameThatShowsAnything) {
  Odometry odometry;
  EXPECT_EQ(odometry.track(dark_frame(0)).status, TrackStatus::kTooFewPoints);
  EXPECT_TRUE(odometry.track(frame_at(on_path(0, 1), 1)));
  const std::vector<TrackedFrame> all = odometry.optimise();
  ASSERT_EQ(all.size(), 2U);
  EXPECT_FALSE(all[0].trusted);
  EXPECT_TRUE(all[1].trusted);
  EXPECT_TRUE(all[1].T_world_camera.isApprox(Eigen::Isometry3d::Identity()));
}

TEST(Odometry, NothingTrackedIsNothingFound) {
  Odometry odometry;
  EXPECT_TRUE(odometry.optimise().empty());
  EXPECT_TRUE(odometry.take_keyframe_database().keyframes.empty());
}

TEST(Odometry, GivenPosesAreKeptAndBecomePlaces) {
  constexpr int kFrames = 30;
  Odometry odometry;
  for (int i = 0; i < kFrames; ++i) odometry.add_posed(frame_at(on_path(i, kFrames), i), on_path(i, kFrames));
  const std::vector<TrackedFrame> all = odometry.optimise();
  ASSERT_EQ(all.size(), static_cast<std::size_t>(kFrames));
  EXPECT_TRUE(all[11].T_world_camera.isApprox(on_path(11, kFrames)));
  EXPECT_TRUE(all[11].trusted);
  const KeyframeDatabase keyframe_database = odometry.take_keyframe_database();
  EXPECT_GT(keyframe_database.keyframes.size(), 2U);
  EXPECT_LT(keyframe_database.keyframes.size(), static_cast<std::size_t>(kFrames));
  for (const MapKeyframe& place : keyframe_database.keyframes) {
    EXPECT_TRUE(place.T_world_camera.isApprox(on_path(static_cast<int>(place.frame_index), kFrames)));
  }
}

TEST(StationaryCamera, SeesAShiftOfHalfAPixelAndNotAHand) {
  Image<float> before(160, 120), shifted(160, 120);
  for (int y = 0; y < 120; ++y) {
    for (int x = 0; x < 160; ++x) {
      before.at(x, y) =
          128.0F + 80.0F * std::sin(0.4F * static_cast<float>(x)) * std::cos(0.3F * static_cast<float>(y));
      shifted.at(x, y) = 128.0F + 80.0F * std::sin(0.4F * (static_cast<float>(x) + 0.5F)) *
                                      std::cos(0.3F * static_cast<float>(y));
    }
  }
  Image<float> with_hand = before;
  for (int y = 0; y < 120; ++y) std::fill_n(with_hand.row(y), 50, 200.0F);
  EXPECT_TRUE(is_camera_stationary(before, before));
  EXPECT_TRUE(is_camera_stationary(before, with_hand));
  EXPECT_FALSE(is_camera_stationary(before, shifted));
  // A person before half of the view leaves the camera stationary, and the more so if it was before.
  Image<float> with_person = before, with_crowd = before;
  for (int y = 0; y < 120; ++y) {
    std::copy_n(shifted.row(y), 80, with_person.row(y));
    std::copy_n(shifted.row(y), 115, with_crowd.row(y));
  }
  EXPECT_TRUE(is_camera_stationary(before, with_person, 1));
  EXPECT_FALSE(is_camera_stationary(before, with_crowd, 1));
  EXPECT_TRUE(is_camera_stationary(before, with_crowd, 5));
  EXPECT_FALSE(is_camera_stationary(before, shifted, 5));
  // A change of exposure is no motion.
  Image<float> brighter = with_person;
  for (float& level : brighter.pixels) level = 1.2F * level + 9.0F;
  EXPECT_TRUE(is_camera_stationary(before, brighter, 1));
  // No edges to compare.
  EXPECT_FALSE(is_camera_stationary(Image<float>(160, 120, 9.0F), Image<float>(160, 120, 9.0F)));
  EXPECT_FALSE(is_camera_stationary(before, Image<float>()));
}

TEST(OdometryOnARecording, KitchenIsFollowedWithoutALoss) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "kitchen");
  const auto source = open_folder(folder);
  Odometry odometry;
  Frame frame;
  std::vector<TimedPose> recorded;
  constexpr int kFrames = 150;
  while (recorded.size() < kFrames && source->next(frame).status == ReadStatus::kFrame) {
    EXPECT_TRUE(odometry.track(frame)) << frame.index;
    ASSERT_TRUE(frame.T_world_camera);
    recorded.push_back({frame.index, frame.stamp_s, *frame.T_world_camera});
  }
  // The recorded poses are KinectFusion's, with errors of some centimetres.
  EXPECT_LT(absolute_trajectory_error(timed(odometry.optimise()), recorded).rmse_m, 0.035);
}

TEST(OdometryOnARecording, AStandingCameraStandsThoughHandsMove) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "cup");
  const auto source = open_folder(folder);
  Odometry odometry;
  Frame frame;
  for (int i = 0; i < 100 && source->next(frame).status == ReadStatus::kFrame; ++i) {
    const Tracking tracking = odometry.track(frame);
    EXPECT_TRUE(tracking) << i;
    EXPECT_LT(tracking.T_world_camera.translation().norm(), 0.005) << i;
  }
}

}  // namespace
}  // namespace roomradar::odometry_test
