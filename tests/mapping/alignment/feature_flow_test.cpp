// feature_flow_test.cpp: corners constrain a pose where depth does not.
#include "mapping/alignment/feature_flow.hpp"

#include <gtest/gtest.h>

#include "mapping/alignment/view_pyramid.hpp"
#include "tests/support/noisy_room.hpp"

namespace roomradar::feature_flow_test {
namespace {

const test::Scene& wall() {
  static const test::Scene scene = test::plane({0, 1, 0}, 2.5);
  return scene;
}
Eigen::Isometry3d before_wall() { return test::looking_at({0, 0.5, 1.2}, {0, 2.5, 1.2}); }

Image<float> grey_of(const Frame& frame) {
  Image<float> grey;
  make_grey(frame.colour, 320, grey);
  return grey;
}

/// An alignment that knows the distance to the wall and two tilts, and keeps the identity in the others.
Tracking aligned_with_wall() {
  Tracking aligned;
  aligned.status = TrackStatus::kDegenerate;
  aligned.unconstrained_dofs = 3;
  for (const int i : {2, 3, 4}) aligned.clear_information(i, i) = 1e6;
  aligned.information = aligned.clear_information;
  return aligned;
}

TEST(FeatureFlow, FollowsAPaintedWallSideways) {
  const Frame first = test::frame_at(before_wall(), 0, wall());
  const Eigen::Isometry3d T_first_second =
      Eigen::Translation3d(0.06, -0.02, 0.0) * Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ());
  const Frame second = test::frame_at(before_wall() * T_first_second, 1, wall());
  const FlowReference reference = make_flow_reference(first, grey_of(first));
  ASSERT_GT(reference.corners_px.size(), 40U);
  const Tracking aligned = aligned_with_wall();
  EXPECT_TRUE(is_weak(aligned));
  const FlowPose pose =
      constrain_by_flow(reference, Eigen::Isometry3d::Identity(), second, grey_of(second), aligned, {});
  ASSERT_TRUE(pose.is_used);
  EXPECT_TRUE(pose.tracking);
  EXPECT_LT((pose.tracking.T_world_camera.translation() - T_first_second.translation()).norm(), 0.006);
  EXPECT_LT(
      Eigen::AngleAxisd(pose.tracking.T_world_camera.linear().transpose() * T_first_second.linear()).angle(),
      0.004);
}

TEST(FeatureFlow, WithoutCornersNothingChanges) {
  const Frame first = test::frame_at(before_wall(), 0, wall());
  Frame dark = first;
  std::fill(dark.colour.pixels.begin(), dark.colour.pixels.end(), Rgb{});
  const FlowReference reference = make_flow_reference(first, grey_of(first));
  const FlowPose pose = constrain_by_flow(reference, Eigen::Isometry3d::Identity(), dark, grey_of(dark),
                                          aligned_with_wall(), {});
  EXPECT_FALSE(pose.is_used);
  EXPECT_EQ(pose.tracking.status, TrackStatus::kDegenerate);
  Frame without_colour = first;
  without_colour.colour.resize(0, 0);
  EXPECT_TRUE(make_flow_reference(without_colour, {}).corners_px.empty());
  Frame without_depth = first;
  std::fill(without_depth.depth_m.pixels.begin(), without_depth.depth_m.pixels.end(), 0.0F);
  EXPECT_TRUE(make_flow_reference(without_depth, grey_of(first)).corners_px.empty());
}

TEST(PoseSigma, SaysWhichDirectionIsFree) {
  Tracking tracking = aligned_with_wall();
  tracking.T_world_camera = before_wall();  // the camera's z is the world's y
  const PoseSigma sigma = pose_sigma(tracking);
  EXPECT_TRUE(std::isinf(sigma.position_m.x()));
  EXPECT_TRUE(std::isinf(sigma.position_m.z()));
  EXPECT_NEAR(sigma.position_m.y(), 1e-3, 1e-6);
  EXPECT_TRUE(std::isinf(sigma.rotation_rad.y()));
  EXPECT_NEAR(sigma.rotation_rad.x(), 1e-3, 1e-6);
  EXPECT_NEAR(sigma.least_certain_world.norm(), 1.0, 1e-9);
  EXPECT_NEAR(sigma.least_certain_world.y(), 0.0, 1e-6);
  tracking.information = 1e6 * Eigen::Matrix<double, 6, 6>::Identity();
  EXPECT_TRUE(pose_sigma(tracking).least_certain_world.isZero());
}

}  // namespace
}  // namespace roomradar::feature_flow_test
