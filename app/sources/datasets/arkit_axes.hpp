// arkit_axes.hpp: conversion of ARKit's poses to roomradar's axes.
#pragma once
#include <Eigen/Geometry>

namespace roomradar {

/// Converts a pose from ARKit's world frame (y up) to roomradar's world frame (z up).
inline Eigen::Isometry3d world_from_arkit_world(const Eigen::Isometry3d& T_arkitworld_camera) {
  Eigen::Isometry3d T_world_arkitworld = Eigen::Isometry3d::Identity();
  T_world_arkitworld.linear() << 1, 0, 0,  //
      0, 0, -1,                            //
      0, 1, 0;
  return T_world_arkitworld * T_arkitworld_camera;
}

/// Converts a camera-to-world pose with ARKit's axes (camera: x right, y up, z backwards; world: y up) to
/// T_world_camera with roomradar's (camera: x right, y down, z forward; world: z up).
inline Eigen::Isometry3d world_from_arkit(const Eigen::Isometry3d& T_arkitworld_arkitcamera) {
  Eigen::Isometry3d T_arkitcamera_camera = Eigen::Isometry3d::Identity();
  T_arkitcamera_camera.linear().diagonal() << 1, -1, -1;
  return world_from_arkit_world(T_arkitworld_arkitcamera * T_arkitcamera_camera);
}

/// Returns the unit direction of gravity in the camera frame, for a world frame with z up.
inline Eigen::Vector3d down_in_camera(const Eigen::Isometry3d& T_world_camera) {
  return -T_world_camera.linear().row(2).transpose();
}

}  // namespace roomradar
