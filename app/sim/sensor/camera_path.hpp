// camera_path.hpp: trajectory of a hand-held camera in a room, drawn at random from a seed.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/sim_options.hpp"

namespace roomradar {

/// A sine of time: amplitude * sin(2 pi rate_hz t + phase_rad).
struct Sway {
  double amplitude = 0.0;
  double rate_hz = 0.0;
  double phase_rad = 0.0;
};

/// A smooth camera path. Without sway, a scan follows an ellipse at constant angular speed, and a viewer
/// stands still. Sway is a sum of sines of time, so all derivatives are continuous.
struct CameraPath {
  CameraPathKind kind = CameraPathKind::kScan;
  /// Centre of the ellipse, or position of a viewer.
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  /// Semi-axes of the ellipse along x and y, m; 0 for a viewer.
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();
  /// Angle on the ellipse at the start.
  double start_rad = 0.0;
  /// Time per round; negative for clockwise motion.
  double loop_s = 1.0;
  /// Point at which the camera looks.
  Eigen::Vector3d target_world = Eigen::Vector3d::Zero();
  /// Sway of the position, m. First index: axis x, y, z of the world. Second index: the sines to add.
  std::array<std::array<Sway, 3>, 3> position_sway{};
  /// Sway of the target, m, along x, y, z of the world.
  std::array<Sway, 3> target_sway{};
  /// Rotation of the camera about its own axes, rad. First index: axis. Second index: the sines to add.
  std::array<std::array<Sway, 2>, 3> turn_sway{};
};

/// Draws up to 64 paths at random and returns the first that keeps 0.5 m from all solids, or else the one
/// with the greatest clearance. During a scan the camera moves at 0.3 to 0.6 m/s and rotates by less than 40
/// degrees per second. If duration_s is long enough for a full round at that speed, the path ends where it
/// began.
CameraPath plan_camera_path(const Room& room, CameraPathKind kind, std::uint64_t seed, double duration_s);

/// Returns the pose of a camera without roll at `eye_world` that looks at `target_world`. The viewing
/// direction must not be vertical.
Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world);

/// Returns the depth camera's pose t_s seconds after the start.
Eigen::Isometry3d T_world_camera_at(const CameraPath& path, double t_s);

}  // namespace roomradar
