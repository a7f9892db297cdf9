// joint_motion.hpp: simultaneous rigid motions of several bodies, each until its first contact.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "mapping/types/system/worker_thread.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/closest_point.hpp"
#include "radar/motion/free_time.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// Restores the orthonormality of T's rotation, which rounding errors degrade.
void make_orthonormal(Eigen::Isometry3d& T);

/// Ball that contains a body's whole path. Radius 0: the body does not move, and sets_that_meet() ignores it.
struct PathBall {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};
/// Stands for no mover.
inline constexpr std::size_t kNoMover = static_cast<std::size_t>(-1);

/// A body that moves simultaneously with others.
struct JointMover {
  Eigen::Isometry3d* T_world_object = nullptr;  ///< in and out
  RigidMotion motion;
  double duration_s = 0.0;  ///< duration of the motion, >= 0
  PathBall path;            ///< contains the whole motion
  struct Free {
    FreeTime time;
    std::size_t limited_by = kNoMover;  ///< mover whose surface limits the time
  };
  /// Returns free_time() of the body at its present pose, for at most this duration, s. Treats movers that
  /// have stopped as at rest. Of two movers that still move, at least one must treat the other as a moving
  /// obstacle. Calls of different movers must be safe on two threads at the same time.
  std::function<Free(double duration_s)> free_time;
  /// Returns the free time, s, with respect to the surfaces of one stopped mover only.
  std::function<double(std::size_t stopped, double duration_s)> free_time_beside;
  std::span<TreeInstance* const> seen_as{};  ///< out: get each new pose: the body in other bodies' scenes
  double gone_s = 0.0;       ///< out: duration of the body's motion so far, s
  bool has_stopped = false;  ///< out: the motion has ended; valid during the call, too
  ClosestPoint limited_by;   ///< out: feature that ended the motion; kind kNothing if another body's did
};

/// Moves all bodies simultaneously, each until its first contact or the end of its duration. Bodies that
/// touch each other stop at the time of impact. The other bodies continue, with the stopped bodies as
/// obstacles at rest. A body's free time is a lower bound. When the free time of a body ends, only that body
/// is queried again, at the present poses of all bodies. The body's motion ends when a query gains less than
/// 2 % of the duration, or after 13 queries. The first query ends it only if it gains nothing.
/// @param sets    sets of bodies. Precondition: the paths of bodies in different sets do not intersect; see
///                sets_that_meet()
/// @param worker  runs some of the bodies' first queries, then some of the sets, on a second thread; results
///                are the same without it; may be null
void move_to_contact(std::span<const std::span<JointMover>> sets, WorkerThread* worker);
/// Moves one set.
void move_to_contact(std::span<JointMover> movers);

/// Returns the connected components of overlapping path balls. Indices are ascending in each component.
std::vector<std::vector<std::size_t>> sets_that_meet(std::span<const PathBall> paths);

}  // namespace roomradar
