// movers.hpp: shapes and motions of moving objects in a simulated room: hand, ball and person.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/sim_options.hpp"

namespace roomradar {

/// A moving object. append_solids() returns its solids at any time.
struct Mover {
  MoverKind kind = MoverKind::kHand;
  /// Hand: position when withdrawn. Ball, person: one end of the path.
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero();
  /// Hand: position above Room::focus_world. Ball, person: other end of the path.
  Eigen::Vector3d to_world = Eigen::Vector3d::Zero();
  /// Hand only: unit direction from the fingers to the elbow.
  Eigen::Vector3d arm_world = Eigen::Vector3d::UnitX();
  /// Ball only: radius.
  double radius_m = 0.0;
  /// Time for the motion from one end to the other and back.
  double period_s = 1.0;
  double phase_rad = 0.0;
  Pace pace = Pace::kSteady;
  /// Pace::kLeaves only: time at which the object begins to leave.
  double leaves_at_s = 0.0;
  /// Pace::kLeaves only: unit, horizontal direction out of the room.
  Eigen::Vector3d out_world = Eigen::Vector3d::UnitX();
  /// Materials, one per solid.
  std::vector<Material> materials;
};

/// Plans the motion of a moving object.
/// @param viewer_world  camera position. A hand passes between the camera and Room::focus_world
/// @param duration_s    duration of the recording. With Pace::kLeaves, the object leaves after half of it
Mover plan_mover(MoverKind kind, const Room& room, const Eigen::Vector3d& viewer_world, std::uint64_t seed,
                 Pace pace = Pace::kSteady, double duration_s = 0.0);

/// Appends the object's solids at time t_s. Number and order of the solids do not depend on t_s. Their
/// positions have continuous derivatives.
void append_solids(const Mover& mover, double t_s, std::vector<Solid>& solids);

}  // namespace roomradar
