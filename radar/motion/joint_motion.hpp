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

/// Ball that contains a body's whole path. Radius 0: the body does not move, and is in no set.
struct PathBall {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};
/// Index of no mover.
inline constexpr std::size_t kNoMover = static_cast<std::size_t>(-1);

/// A body that moves together with others.
struct JointMover {
  Eigen::Isometry3d* T_world_object = nullptr;  ///< in and out
  RigidMotion motion;
  double duration_s = 0.0;  ///< of the motion, >= 0
  PathBall path;            ///< of the whole motion
  struct Free {
    FreeTime time;
    std::size_t limited_by = kNoMover;  ///< mover whose surface limits the time
  };
  /// Returns free_time() of the body at its present pose, for at most this duration, s. Movers that have
  /// stopped are at rest. Between two others, one of both has to include the other, with its motion.
  std::function<Free(double duration_s)> free_time;
  /// The same, but only of surfaces of one mover that has stopped, s.
  std::function<double(std::size_t stopped, double duration_s)> free_time_beside;
  /// Called after each change of the pose; may be null or empty.
  const std::function<void()>* moved = nullptr;
  double gone_s = 0.0;       ///< out: duration of the body's motion
  bool has_stopped = false;  ///< out: ended before the others; valid at any time
  ClosestPoint limited_by;   ///< out: feature that ended the motion; kind kNothing if another body's did
};

/// Moves all bodies at the same time, each until its first contact or the end of its duration. A body that
/// meets another one stops with it; the others move on, past the two at rest. A body's free time is a lower
/// bound: when it ends, only this body is queried again, at the poses of that moment. Its motion ends when a
/// query gains less than 2 % of its duration.
void move_to_contact(std::span<JointMover> movers);

/// Returns the connected components of overlapping balls, as indices in ascending order.
std::vector<std::vector<std::size_t>> sets_that_meet(std::span<const PathBall> paths);

}  // namespace roomradar
