// session_values.hpp: states of a session's objects, as copies for Python.
#pragma once
#include <pybind11/pybind11.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/virtual_object.hpp"

namespace roomradar::python {

/// A point where an object touches a surface or another object.
struct TouchPoint {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, towards the object
  double gap_m = 0.0;
  SurfaceKind kind = SurfaceKind::kNothing;
  std::string other;  ///< name of the other object; empty: a surface
};

/// State of an object after a frame, copied from the session.
struct ObjectSnapshot {
  std::string name;
  std::string state;  ///< outside, carried, stuck, at rest or moving
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();
  std::optional<SurfaceKind> rests_on;  ///< only at rest
  double mass_kg = 0.0;
  std::vector<TouchPoint> contacts;
};
ObjectSnapshot snapshot_of(const VirtualObject& object);

}  // namespace roomradar::python
