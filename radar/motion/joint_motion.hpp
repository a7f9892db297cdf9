// joint_motion.hpp: rigid motions of several bodies at the same time, until the first contact.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "radar/motion/closest_point.hpp"
#include "radar/motion/free_time.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Restores the orthonormality of T's rotation, which rounding errors degrade.
void make_orthonormal(Eigen::Isometry3d& T);

/// A body that moves together with others.
struct JointMover {
  Eigen::Isometry3d* T_world_object = nullptr;  ///< in and out
  RigidMotion motion;
  /// Returns free_time() of the body at its present pose, for at most this duration, s. Between two movers,
  /// one of both has to include the other, with its motion.
  std::function<FreeTime(double duration_s)> free_time;
  const std::function<void()>* moved =
      nullptr;              ///< called after each change of the pose; may be null or empty
  ClosestPoint limited_by;  ///< out: feature that ended the motion; kind kNothing if another body's did
};

/// Moves all bodies at the same time, until the first contact of any of them. A body's free time is a lower
/// bound: when the least one ends, only this body is queried again, at the poses of that moment. The motion
/// ends when a query gains less than 2 % of the duration.
/// @param duration_s  > 0
/// @return duration of the motion, s, <= duration_s
double move_to_contact(std::span<JointMover> movers, double duration_s);

/// Ball that contains a body's whole path. Radius 0: the body does not move, and is in no set.
struct PathBall {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};
/// Returns the connected components of overlapping balls, as indices in ascending order.
std::vector<std::vector<std::size_t>> sets_that_meet(std::span<const PathBall> paths);

}  // namespace roomradar
