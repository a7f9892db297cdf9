// sweep.hpp: until when is an object free that moves and turns?
#pragma once
#include <Eigen/Geometry>
#include <limits>

#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// When a straight motion at this speed touches: no earlier than lower_s, no later than upper_s (infinite
/// where nothing was found or nothing moves).
struct ContactTime {
  double lower_s = 0.0;
  double upper_s = std::numeric_limits<double>::infinity();
};
/// @param contact  for the direction of the velocity; kOverlap: both are 0
/// @param speed_m_s >= 0
ContactTime contact_time(const Contact& contact, double speed_m_s);

/// A point of the object goes straight and the object turns about it, both evenly.
struct RigidMotion {
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();     ///< of the centre, in the world
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();  ///< about the centre, world axes, right-handed
  Eigen::Vector3d centre_object = Eigen::Vector3d::Zero();  ///< in the object's frame, m
};
/// The pose after time_s of the motion; from the start's, so that nothing adds up.
Eigen::Isometry3d pose_after(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                             double time_s);

enum class SweepStatus {
  kInvalidInput,  ///< as the radar's, or a motion, duration or config that is not finite or negative
  kNoAnswer,      ///< the radar had none; safe_s holds
  kFree,          ///< for the whole duration
  kContact,       ///< stopped at safe_s, tolerance_m or less of way before a touch
  kOverlap,       ///< not free at the start
  kOutOfQueries,  ///< max_queries were not enough; safe_s holds, what comes then is not known
};

struct SweepConfig {
  /// What would touch while no point of the object goes farther than this counts as touching, m. > 0
  double tolerance_m = 1e-4;
  int max_queries = 256;
};

struct [[nodiscard]] SweepResult {
  SweepStatus status = SweepStatus::kInvalidInput;
  double safe_s = 0.0;  ///< free up to this time for certain
  /// By this time it touches for certain; infinite where that could not be shown (free, or a graze that may
  /// yet be a miss).
  double contact_s = std::numeric_limits<double>::infinity();
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< at safe_s
  /// What stopped it, at contact_s where that is finite: its point, normal and kind; its travel and bounds
  /// are those of the one query that told of it.
  Contact contact;
  int queries = 0;
};

/// Moves the object until something is in the way.
///
/// A step takes as much time as can be shown free by one query: the object in its orientation half-way, moved
/// straight, thickened by as much as the turning can carry a point away from there: the chord 2 R sin(a / 4)
/// of half the step's turn a at the greatest distance R from the axis. What is free for the thickened object
/// is free for every moment of the step, whatever the speed, so nothing is tunnelled through. Where a step
/// turns so far that the chord is longer than R, the capsule that holds the object in every orientation is
/// asked about instead. Steps double while they succeed and halve where they do not; what turns on the spot
/// and is free for a turn is free for ever; with no turn one query is the answer.
///
/// An object that touches and turns (by more than a nanometre) is stopped at once, even where it would leave:
/// keep a gap. A stopped object has one, of up to tolerance_m.
///
/// Allocates a few hundred bytes; all else is the radar's.
SweepResult sweep(CyberRadar& radar, const TreeInstance& object, const RigidMotion& motion, double duration_s,
                  const RadarScene& scene, const SweepConfig& config = {});

}  // namespace roomradar
