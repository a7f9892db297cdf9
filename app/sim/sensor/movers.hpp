// movers.hpp: moving objects of a simulated room: a hand, a ball, a person.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/sim_options.hpp"

namespace roomradar {

/// Motion of one object, which determines its shape at any time.
struct Mover {
  MoverKind kind = MoverKind::kHand;
  /// Withdrawn position of the hand; one end of the path of the ball or person.
  Eigen::Vector3d from_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d to_world = Eigen::Vector3d::Zero();  ///< hand over the focus; other end of the path
  /// Hand: unit direction from the fingers to the elbow.
  Eigen::Vector3d arm_world = Eigen::Vector3d::UnitX();
  double radius_m = 0.0;  ///< ball
  double period_s = 1.0;  ///< time there and back
  double phase_rad = 0.0;
  Pace pace = Pace::kSteady;
  double leaves_at_s = 0.0;                              ///< Pace::kLeaves only
  Eigen::Vector3d out_world = Eigen::Vector3d::UnitX();  ///< unit, horizontal: direction out of the room
  std::vector<Material> materials;                       ///< one per solid
};

/// @param viewer_world  camera position: the hand passes between it and the room's focus
/// @param duration_s    of the recording: with Pace::kLeaves the mover leaves at half of it
Mover plan_mover(MoverKind kind, const Room& room, const Eigen::Vector3d& viewer_world, std::uint64_t seed,
                 Pace pace = Pace::kSteady, double duration_s = 0.0);

/// Appends the mover's solids at time t_s; their number and order never change. All positions have continuous
/// derivatives in time.
void append_solids(const Mover& mover, double t_s, std::vector<Solid>& solids);

}  // namespace roomradar
