// roomradar_axes.cpp: exported functions: conversions to the axes of game engines.
#include "app/c_api/roomradar_axes.h"

#include <cmath>

#include "app/c_api/conversions.hpp"

using namespace roomradar;
using namespace roomradar::c_api;

namespace {

/// Applies a matrix to count x 3 numbers. NaN stays NaN.
void convert(const Eigen::Matrix3d& by, const double* from, double* to, size_t count) {
  if (count == 0) return;
  require_given(from, "the points");
  require_given(to, "the result");
  for (size_t i = 0; i < 3 * count; i += 3)
    write_vector(by * Eigen::Vector3d(from[i], from[i + 1], from[i + 2]), to + i);
}

/// Converts a pose: `of_node` turns the node's axes, `of_space` those of the space around it.
void convert(const Eigen::Matrix3d& of_space, const Eigen::Matrix3d& of_node, double scale,
             const roomradar_pose* from, roomradar_pose* to) {
  require_given(to, "the result");
  const Eigen::Isometry3d T = pose_of(from, "the pose");
  Eigen::Isometry3d converted = Eigen::Isometry3d::Identity();
  converted.linear() = of_space * T.linear() * of_node.transpose();
  converted.translation() = scale * (of_space * T.translation());
  *to = pose_of(converted);
}

}  // namespace

roomradar_status roomradar_points_to_engine(int32_t axes, const double* points_world_m, double* points_engine,
                                            size_t count) {
  return guarded("roomradar_points_to_engine", nullptr, [&] {
    const EngineAxes& engine = engine_axes(axes);
    convert(engine.units_per_m * engine.C_engine_world, points_world_m, points_engine, count);
  });
}

roomradar_status roomradar_points_from_engine(int32_t axes, const double* points_engine,
                                              double* points_world_m, size_t count) {
  return guarded("roomradar_points_from_engine", nullptr, [&] {
    const EngineAxes& engine = engine_axes(axes);
    convert(engine.C_engine_world.transpose() / engine.units_per_m, points_engine, points_world_m, count);
  });
}

roomradar_status roomradar_pose_to_engine(int32_t axes, const roomradar_pose* T_world_object,
                                          roomradar_pose* T_engine_object) {
  return guarded("roomradar_pose_to_engine", nullptr, [&] {
    const EngineAxes& engine = engine_axes(axes);
    convert(engine.C_engine_world, engine.C_engine_world, engine.units_per_m, T_world_object,
            T_engine_object);
  });
}

roomradar_status roomradar_pose_from_engine(int32_t axes, const roomradar_pose* T_engine_object,
                                            roomradar_pose* T_world_object) {
  return guarded("roomradar_pose_from_engine", nullptr, [&] {
    const EngineAxes& engine = engine_axes(axes);
    convert(engine.C_engine_world.transpose(), engine.C_engine_world.transpose(), 1.0 / engine.units_per_m,
            T_engine_object, T_world_object);
  });
}

roomradar_status roomradar_camera_to_engine(int32_t axes, const roomradar_pose* T_world_camera,
                                            roomradar_pose* T_engine_camera) {
  return guarded("roomradar_camera_to_engine", nullptr, [&] {
    const EngineAxes& engine = engine_axes(axes);
    convert(engine.C_engine_world, engine.C_engine_camera, engine.units_per_m, T_world_camera,
            T_engine_camera);
  });
}

roomradar_status roomradar_camera_from_engine(int32_t axes, const roomradar_pose* T_engine_camera,
                                              roomradar_pose* T_world_camera) {
  return guarded("roomradar_camera_from_engine", nullptr, [&] {
    const EngineAxes& engine = engine_axes(axes);
    convert(engine.C_engine_world.transpose(), engine.C_engine_camera.transpose(), 1.0 / engine.units_per_m,
            T_engine_camera, T_world_camera);
  });
}

roomradar_status roomradar_quaternion(const roomradar_pose* pose, double q_xyzw[4]) {
  return guarded("roomradar_quaternion", nullptr, [&] {
    require_given(q_xyzw, "q_xyzw");
    Eigen::Quaterniond q(pose_of(pose, "pose").linear());
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();
    q.normalize();
    for (int i = 0; i < 4; ++i) q_xyzw[i] = q.coeffs()[i];
  });
}

roomradar_status roomradar_vertical_fov(const roomradar_camera* camera, double* fov_rad) {
  return guarded("roomradar_vertical_fov", nullptr, [&] {
    require_given(fov_rad, "fov_rad");
    const Intrinsics of = camera_of(camera, "camera");
    *fov_rad = 2.0 * std::atan(0.5 * of.height_px / of.fy_px);
  });
}
