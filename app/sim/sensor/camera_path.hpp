// camera_path.hpp: trajectory of a hand-held camera in a room, drawn at random from a seed.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/sim_options.hpp"

namespace roomradar {

/// A sine of time: amplitude * sin(2 pi rate_hz t + phase_rad).
struct Sway {
  double amplitude = 0.0;
  double rate_hz = 0.0;
  double phase_rad = 0.0;
};

/// A smooth camera path. A scan (kScan) follows an ellipse at nearly constant speed. A viewer (kView) stands
/// still. Sway, a sum of sines of time, is added to both. All derivatives are thus continuous.
struct CameraPath {
  CameraPathKind kind = CameraPathKind::kScan;
  /// Centre of the ellipse, or position of a viewer.
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  /// Semi-axes of the ellipse along x and y, m; 0 for a viewer.
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();
  /// Angle on the ellipse at the start.
  double start_rad = 0.0;
  /// Time per revolution on the ellipse; negative for clockwise motion.
  double loop_s = 1.0;
  /// Walk through several rooms, which replaces the ellipse; see Room::walk. A uniform cubic B-spline with
  /// these control points. `start_rad` and `loop_s` apply to a closed walk as to an ellipse.
  std::vector<WalkPoint> walk;
  /// Time between two control points of an open walk; 0: the walk is closed. See Room::walk_step_s.
  double walk_step_s = 0.0;
  /// Number of full turns of the view on the closed walk.
  int walk_turns = 0;
  /// Point at which the camera looks. On a walk, the camera looks at a point 1.5 m away in the direction
  /// WalkPoint::yaw_rad. Only the z coordinates of target_world and centre_world are then used, as heights of
  /// that point and of the camera above the floor.
  Eigen::Vector3d target_world = Eigen::Vector3d::Zero();
  /// Sway of the position, m. First index: world axis x, y or z. Second index: terms of the sum.
  std::array<std::array<Sway, 3>, 3> position_sway{};
  /// Sway of the target, m, along the world axes x, y and z.
  std::array<Sway, 3> target_sway{};
  /// Sway of the camera's rotation about its own axes, rad. First index: axis. Second index: terms of the
  /// sum.
  std::array<std::array<Sway, 2>, 3> turn_sway{};
};

/// Draws up to 64 paths at random. Returns the first path with a clearance of 0.5 m from all solids. If there
/// is none, returns the path with the max clearance. During a scan, the camera moves at about 0.3 to 0.6 m/s
/// and rotates by less than 40 degrees/s. The path ends at its start if a whole number of revolutions fits
/// duration_s at 0.5 m/s or less. On an open walk, which passes narrow doorways, the clearance is 0.4 m, and
/// the camera is 1.3 to 1.6 m above the floor or step.
CameraPath plan_camera_path(const Room& room, CameraPathKind kind, std::uint64_t seed, double duration_s);

/// Adds swings of 25 degrees to each side, at up to turn_dps degrees/s; nothing if turn_dps is 0.
void add_turns(CameraPath& path, double turn_dps);

/// Returns the pose of a camera at eye_world that looks at target_world, with a horizontal x axis. The
/// viewing direction must not be vertical.
Eigen::Isometry3d looking_at(const Eigen::Vector3d& eye_world, const Eigen::Vector3d& target_world);

/// Returns the depth camera's pose t_s seconds after the start.
Eigen::Isometry3d T_world_camera_at(const CameraPath& path, double t_s);

}  // namespace roomradar
