// up_direction_test.cpp: up direction from gravity, from dominant planes, and without either.
#include "mapping/odometry/up_direction.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace roomradar::up_direction_test {
namespace {

constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 80.0, 60.0};

double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180.0 / std::numbers::pi;
}

/// View of a camera at height 1.5 m, pitched down: an infinite floor and a wall 3 m ahead.
Frame room_frame(double pitch_down_deg) {
  Frame frame;
  frame.depth_camera = kCamera;
  frame.depth_m.resize(kCamera.width_px, kCamera.height_px);
  const double pitch = pitch_down_deg * std::numbers::pi / 180.0;
  const Eigen::Vector3d up_camera(0.0, -std::cos(pitch), -std::sin(pitch));
  const Eigen::Vector3d forward_camera(0.0, -std::sin(pitch), std::cos(pitch));
  for (int y = 0; y < kCamera.height_px; ++y) {
    for (int x = 0; x < kCamera.width_px; ++x) {
      const Eigen::Vector3d ray = back_project(kCamera, x, y, 1.0);
      double depth_m = 3.0 / std::max(ray.dot(forward_camera), 1e-6);
      if (ray.dot(up_camera) < 0) depth_m = std::min(depth_m, -1.5 / ray.dot(up_camera));
      frame.depth_m.at(x, y) = depth_m < 8.0 ? static_cast<float>(depth_m) : 0.0F;
    }
  }
  return frame;
}

TEST(UpDirection, FloorIsFoundFromAPitchedCamera) {
  for (const double pitch_deg : {20.0, 45.0}) {
    UpEstimator estimator;
    estimator.add(room_frame(pitch_deg), Eigen::Isometry3d::Identity());
    const UpDirection up = estimator.estimate();
    const double pitch = pitch_deg * std::numbers::pi / 180.0;
    EXPECT_EQ(up.source, UpSource::kPlane);
    EXPECT_LT(angle_deg(up.up_world, {0.0, -std::cos(pitch), -std::sin(pitch)}), 0.2);
  }
}

TEST(UpDirection, AccelerometerIsPreferredToPlanes) {
  Frame frame = room_frame(20.0);
  frame.down_camera = Eigen::Vector3d(0.1, 0.9, 0.2).normalized();
  UpEstimator estimator;
  estimator.add(frame, Eigen::Isometry3d::Identity());
  const UpDirection up = estimator.estimate();
  EXPECT_EQ(up.source, UpSource::kAccelerometer);
  EXPECT_LT(angle_deg(up.up_world, -*frame.down_camera), 1e-5);
}

TEST(UpDirection, PoseOfTheCameraIsTakenIntoAccount) {
  const Eigen::Isometry3d T_world_camera(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()));
  UpEstimator estimator;
  estimator.add(room_frame(30.0), T_world_camera);
  const Eigen::Vector3d up_camera(0.0, -std::cos(std::numbers::pi / 6), -std::sin(std::numbers::pi / 6));
  EXPECT_LT(angle_deg(estimator.estimate().up_world, T_world_camera.linear() * up_camera), 0.2);
}

TEST(UpDirection, NothingSeenMeansTheCamerasOwnUp) {
  Frame frame = room_frame(0.0);
  std::fill(frame.depth_m.pixels.begin(), frame.depth_m.pixels.end(), 0.0F);
  UpEstimator estimator;
  EXPECT_EQ(estimator.estimate().source, UpSource::kNone);
  estimator.add(frame, Eigen::Isometry3d::Identity());
  EXPECT_EQ(estimator.estimate().source, UpSource::kNone);
  EXPECT_LT(angle_deg(estimator.estimate().up_world, {0, -1, 0}), 1e-6);
}

TEST(UpDirection, FramesOfALongScanHaveTheSameSayFromFirstToLast) {
  const Frame frame = room_frame(20.0);
  const Eigen::Isometry3d T_world_tilted(Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()));
  UpEstimator estimator;
  for (int i = 0; i < 100; ++i) estimator.add(frame, T_world_tilted);
  for (int i = 0; i < 200; ++i) estimator.add(frame, Eigen::Isometry3d::Identity());
  const double pitch = 20.0 * std::numbers::pi / 180.0;
  EXPECT_LT(angle_deg(estimator.estimate().up_world, {0.0, -std::cos(pitch), -std::sin(pitch)}), 0.2);
}

TEST(LevelRotation, TakesUpToZWithoutMovingAnything) {
  for (const Eigen::Vector3d& up :
       {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0, 0, -1),
        Eigen::Vector3d(0.3, -0.8, 0.1).normalized()}) {
    const Eigen::Isometry3d T = level_rotation(up);
    EXPECT_LT((T * up - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(T.linear().determinant(), 1.0, 1e-12);
    EXPECT_EQ(T.translation().norm(), 0.0);
  }
}

}  // namespace
}  // namespace roomradar::up_direction_test
