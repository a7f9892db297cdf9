// time_of_impact.hpp: time of impact of a moving and rotating object, by conservative advancement.
#pragma once
#include <Eigen/Geometry>
#include <limits>

#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// Time of contact of a straight motion, between lower_s and upper_s. upper_s is infinite if no contact was
/// found or nothing moves.
struct ContactTime {
  double lower_s = 0.0;
  double upper_s = std::numeric_limits<double>::infinity();
};
/// @param contact  result for the direction of the velocity; for kOverlap both times are 0
/// @param speed_m_s  >= 0
ContactTime contact_time(const Contact& contact, double speed_m_s);

/// Constant linear velocity of a point of the object, and constant rotation of the object about it.
struct RigidMotion {
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();     ///< velocity of the centre, in the world
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();  ///< about the centre, world axes, right-handed
  Eigen::Vector3d centre_object = Eigen::Vector3d::Zero();  ///< centre of rotation in the object's frame, m
};
/// Returns the pose after time_s of the motion, computed from the start pose, so no error accumulates.
Eigen::Isometry3d pose_after(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                             double time_s);

enum class TimeOfImpactStatus {
  kInvalidInput,  ///< as CyberRadar's; or motion, duration or config not finite or out of range
  kNoAnswer,      ///< a radar query failed; safe_s is valid
  kFree,          ///< free for the whole duration
  kContact,       ///< stopped at safe_s, at most tolerance_m of motion before contact
  kOverlap,       ///< not free at the start
  kOutOfQueries,  ///< max_queries reached; safe_s is valid, later times are unknown
};

struct TimeOfImpactConfig {
  /// Contact tolerance, m, > 0: contact before any point travels this far counts as touching.
  double tolerance_m = 1e-4;
  int max_queries = 256;
};

struct [[nodiscard]] TimeOfImpact {
  TimeOfImpactStatus status = TimeOfImpactStatus::kInvalidInput;
  double safe_s = 0.0;  ///< certainly free up to this time
  /// Certainly in contact by this time; infinite if that could not be shown (free, or a graze that may miss).
  double contact_s = std::numeric_limits<double>::infinity();
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< pose at safe_s
  /// Contact that stopped the motion, at contact_s if that is finite (point, normal and kind). Its travel and
  /// bounds are those of the single query that found it.
  Contact contact;
  int queries = 0;
};

/// Moves the object until contact.
///
/// Each step is as long as one query can show to be free. The query moves the object straight, in its
/// orientation half-way through the step, inflated by how far rotation can carry a point from there. That is
/// the chord 2 R sin(a / 4) of half the step's rotation a, at the greatest distance R from the axis. What is
/// free for the inflated object is free at every moment of the step, so nothing tunnels at any speed. If the
/// chord is longer than R, the query uses the capsule that contains the object in every orientation. Steps
/// double on success and halve on failure. An object that rotates in place and is free for a full turn is
/// free for the whole duration; without rotation a single query gives the result.
///
/// An object that touches while rotating (by more than a nanometre) is stopped at once, even if it would
/// separate, so callers should keep a gap. A stopped object has a gap of up to tolerance_m.
///
/// Allocates a few hundred bytes in addition to the radar's memory.
TimeOfImpact time_of_impact(CyberRadar& radar, const TreeInstance& object, const RigidMotion& motion,
                            double duration_s, const RadarScene& scene,
                            const TimeOfImpactConfig& config = {});

}  // namespace roomradar
