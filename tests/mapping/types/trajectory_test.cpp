// trajectory_test.cpp: the TUM file format, and the absolute trajectory error.
#include "mapping/types/trajectory.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "mapping/types/system/error.hpp"

namespace roomradar::trajectory_test {
namespace {

class TrajectoryFile : public ::testing::Test {
 protected:
  std::filesystem::path path_ =
      std::filesystem::path(::testing::TempDir()) /
      (std::string("trajectory_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".txt");
  void TearDown() override { std::filesystem::remove(path_); }
  std::string message_for(const std::string& content) {
    std::ofstream(path_) << content;
    try {
      (void)read_trajectory(path_);
    } catch (const Error& error) {
      return error.what();
    }
    return "accepted";
  }
};

std::vector<TimedPose> random_walk(int poses, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> step(0.0, 0.1);
  std::vector<TimedPose> walk;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int i = 0; i < poses; ++i) {
    const Eigen::Vector3d axis(step(random), step(random), step(random));
    T = T * Eigen::Translation3d(step(random), step(random), step(random)) *
        Eigen::AngleAxisd(axis.norm(), axis.normalized());
    walk.push_back({i, i / 30.0, T});
  }
  return walk;
}

TEST_F(TrajectoryFile, ComesBackAsItWas) {
  const std::vector<TimedPose> walk = random_walk(50, 1);
  write_trajectory(path_, walk);
  const std::vector<TimedPose> back = read_trajectory(path_);
  ASSERT_EQ(back.size(), walk.size());
  for (std::size_t i = 0; i < walk.size(); ++i) {
    EXPECT_NEAR(back[i].stamp_s, walk[i].stamp_s, 1e-9);
    EXPECT_TRUE(back[i].T_world_camera.isApprox(walk[i].T_world_camera, 1e-9));
  }
}

TEST_F(TrajectoryFile, FaultsAreNamedWithTheirLine) {
  EXPECT_EQ(message_for("# comment\n0 0 0 0 0 0 0 1\n"), "accepted");
  EXPECT_NE(message_for("0 0 0 0 0 0 0 1\n1 2 3\n").find(":2:"), std::string::npos);
  EXPECT_NE(message_for("0 0 0 nan 0 0 0 1\n").find(":1:"), std::string::npos);
  EXPECT_NE(message_for("0 0 0 0 0 0 0 0\n").find("quaternion"), std::string::npos);
  EXPECT_NE(message_for("hello\n").find("hello"), std::string::npos);
  EXPECT_THROW((void)read_trajectory("no/such/file.txt"), Error);
  EXPECT_THROW(write_trajectory("no/such/folder/file.txt", {}), Error);
}

TEST(TrajectoryError, IsZeroForAMovedCopyAndKnownForAKnownOffset) {
  const std::vector<TimedPose> reference = random_walk(100, 2);
  const Eigen::Isometry3d T_moved =
      Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 1, 0).normalized());
  std::vector<TimedPose> estimate = reference;
  for (TimedPose& pose : estimate) pose.T_world_camera = T_moved * pose.T_world_camera;
  const TrajectoryError exact = absolute_trajectory_error(estimate, reference);
  EXPECT_EQ(exact.poses, 100U);
  EXPECT_LT(exact.rmse_m, 1e-9);
  EXPECT_TRUE((exact.T_reference_estimate * T_moved).isApprox(Eigen::Isometry3d::Identity(), 1e-9));

  // A zigzag: poses alternate between +2 cm and -2 cm in x. The best alignment leaves nearly all of this
  // error.
  std::vector<TimedPose> line(100);
  for (int i = 0; i < 100; ++i)
    line[i] = {i, i / 30.0, Eigen::Isometry3d(Eigen::Translation3d(0, 0.1 * i, 0.01 * i * i))};
  std::vector<TimedPose> zigzag = line;
  for (int i = 0; i < 100; ++i) zigzag[i].T_world_camera.translation().x() += i % 2 ? 0.02 : -0.02;
  EXPECT_NEAR(absolute_trajectory_error(zigzag, line).rmse_m, 0.02, 1e-3);
}

TEST(TrajectoryError, MatchesByFrameAndNeedsThree) {
  std::vector<TimedPose> reference = random_walk(10, 3);
  std::vector<TimedPose> estimate = {reference[7], reference[2], reference[5]};
  EXPECT_EQ(absolute_trajectory_error(estimate, reference).poses, 3U);
  EXPECT_LT(absolute_trajectory_error(estimate, reference).rmse_m, 1e-9);
  estimate.pop_back();
  EXPECT_EQ(absolute_trajectory_error(estimate, reference).poses, 0U);
}

TEST(PoseAlignment, KnowsTheTurnOfACameraThatHardlyMoved) {
  const Eigen::Isometry3d T_moved =
      Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 1, 0).normalized());
  // 5 mm back and forth, with errors of 2 mm and 2 mrad: positions alone would not determine the rotation.
  std::vector<TimedPose> reference(20), estimate(20);
  const Eigen::Matrix3d wrong = Eigen::AngleAxisd(0.002, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int i = 0; i < 20; ++i) {
    reference[i] = {i, i / 30.0, Eigen::Isometry3d(Eigen::Translation3d(1, 1 + 0.005 * (i % 2), 1.5))};
    estimate[i] = {i, i / 30.0, T_moved * reference[i].T_world_camera};
    estimate[i].T_world_camera.translate(0.002 * Eigen::Vector3d(i % 3 - 1, i % 5 - 2, i % 7 - 3) / 3.0);
    estimate[i].T_world_camera.rotate(i % 2 ? wrong : wrong.transpose());
  }
  const auto turn_deg = [&](const Eigen::Isometry3d& T_reference_estimate) {
    return Eigen::AngleAxisd((T_reference_estimate * T_moved).linear()).angle() * 180.0 / M_PI;
  };
  EXPECT_GT(turn_deg(absolute_trajectory_error(estimate, reference).T_reference_estimate), 5.0);
  const auto T_reference_estimate = pose_alignment(estimate, reference);
  ASSERT_TRUE(T_reference_estimate);
  EXPECT_LT(turn_deg(*T_reference_estimate), 0.1);
  EXPECT_LT((*T_reference_estimate * estimate[3].T_world_camera.translation() -
             reference[3].T_world_camera.translation())
                .norm(),
            0.005);

  estimate.resize(1);
  const Eigen::Isometry3d T_one = reference.front().T_world_camera * estimate[0].T_world_camera.inverse();
  EXPECT_TRUE(pose_alignment(estimate, reference)->isApprox(T_one, 1e-9));
  estimate[0].frame_index = 99;
  EXPECT_FALSE(pose_alignment(estimate, reference));
  EXPECT_FALSE(pose_alignment({}, {}));
}

TEST(TrajectoryError, GapAtTheEndIsSeenFromTheFirstPose) {
  const std::vector<TimedPose> reference = random_walk(20, 4);
  const Eigen::Isometry3d T_moved =
      Eigen::Translation3d(3, -2, 1) * Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 1, 0).normalized());
  std::vector<TimedPose> estimate = {reference.front(), reference.back()};  // poses in between do not matter
  for (TimedPose& pose : estimate) pose.T_world_camera = T_moved * pose.T_world_camera;
  EXPECT_LT(end_gap_m(estimate, reference), 1e-9);
  estimate.back().T_world_camera.translate(Eigen::Vector3d(0, 0.03, 0.04));
  EXPECT_NEAR(end_gap_m(estimate, reference), 0.05, 1e-9);
  EXPECT_EQ(end_gap_m({}, reference), 0.0);
  EXPECT_EQ(end_gap_m(estimate, {}), 0.0);
}

}  // namespace
}  // namespace roomradar::trajectory_test
