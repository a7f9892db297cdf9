// camera_path.hpp: trajectory of a hand-held camera in a room, by seed.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/sim_options.hpp"

namespace roomradar {

/// A sine over time.
struct Sway {
  double amplitude = 0.0;
  double rate_hz = 0.0;
  double phase_rad = 0.0;
};

/// Position and target are sums of sines of time, so all derivatives are continuous.
struct CameraPath {
  CameraPathKind kind = CameraPathKind::kScan;
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();  ///< centre of the ellipse; position of a viewer
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();        ///< half axes of the ellipse; 0 for a viewer
  double start_rad = 0.0;
  double loop_s = 1.0;  ///< time per round; negative: clockwise
  Eigen::Vector3d target_world = Eigen::Vector3d::Zero();
  std::array<std::array<Sway, 3>, 3> position_sway{};  ///< m, along x, y, z of the world
  std::array<Sway, 3> target_sway{};                   ///< m, along x, y, z of the world
  std::array<std::array<Sway, 2>, 3> turn_sway{};      ///< rad, about the camera's own axes
};

/// Draws up to 64 paths and returns the first that keeps 0.5 m from all solids, else the one with the most
/// clearance. A scan moves at 0.3 to 0.6 m/s and rotates by less than 40 degrees per second; if duration_s is
/// long enough for a full round at that speed, it ends where it began.
CameraPath plan_camera_path(const Room& room, CameraPathKind kind, std::uint64_t seed, double duration_s);

/// Returns the pose of a level camera at `eye_world` that looks at `target_world`, not straight up or down.
Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world);

/// Returns the depth camera's pose t_s after the start.
Eigen::Isometry3d T_world_camera_at(const CameraPath& path, double t_s);

}  // namespace roomradar
