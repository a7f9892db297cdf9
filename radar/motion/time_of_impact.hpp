// time_of_impact.hpp: time of impact of a moving and rotating object, by conservative advancement.
#pragma once
#include <Eigen/Geometry>
#include <limits>

#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// Bounds of the time of contact of a straight motion. upper_s is infinite without contact or at speed 0.
struct ContactTime {
  double lower_s = 0.0;
  double upper_s = std::numeric_limits<double>::infinity();
};
/// Converts a distance to contact into a time.
/// @param contact  result of a query along the velocity; for kOverlap, both bounds are 0
/// @param speed_m_s  speed of the object, >= 0
ContactTime contact_time(const Contact& contact, double speed_m_s);

/// Constant linear velocity of a point of the object, and constant rotation of the object about that point.
struct RigidMotion {
  /// Linear velocity of the centre of rotation, in the world.
  Eigen::Vector3d linear_m_s = Eigen::Vector3d::Zero();
  /// Angular velocity about the centre of rotation, world axes, right-handed.
  Eigen::Vector3d angular_rad_s = Eigen::Vector3d::Zero();
  /// Centre of rotation in the object's frame, m.
  Eigen::Vector3d centre_object = Eigen::Vector3d::Zero();
};
/// Returns the object's pose after time_s from the start pose T_world_object.
Eigen::Isometry3d pose_after(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                             double time_s);

enum class TimeOfImpactStatus {
  /// CyberRadar rejects the query, or motion, duration or config is not finite or out of range.
  kInvalidInput,
  /// A radar query failed; safe_s is valid.
  kNoAnswer,
  /// The whole duration is free of contact.
  kFree,
  /// The object stopped at safe_s. It may make contact before any point moves tolerance_m farther.
  kContact,
  /// The object overlaps the scene at the start.
  kOverlap,
  /// max_queries was reached; safe_s is valid, later times are unknown.
  kOutOfQueries,
};

struct TimeOfImpactConfig {
  /// Contact tolerance, m, > 0. The object stops where it may make contact before any of its points travels
  /// this far.
  double tolerance_m = 1e-4;
  /// Max number of radar queries.
  int max_queries = 256;
};

struct [[nodiscard]] TimeOfImpact {
  TimeOfImpactStatus status = TimeOfImpactStatus::kInvalidInput;
  /// The motion is certainly free up to this time.
  double safe_s = 0.0;
  /// The object is certainly in contact by this time. Infinite if contact could not be proved: there is none,
  /// or the object grazes a surface and may miss it.
  double contact_s = std::numeric_limits<double>::infinity();
  /// Pose of the object at safe_s.
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  /// Contact that stopped the motion (point, normal and kind), at contact_s if contact_s is finite. The
  /// contact's distances are those of the single query that found it.
  Contact contact;
  /// Number of radar queries run.
  int queries = 0;
};

/// Moves the object until contact, by conservative advancement.
///
/// The motion is divided into steps, each proved free by one query. The query moves the object along a
/// straight line, in its orientation half-way through the step, inflated by the chord 2 R sin(a / 4). Here a
/// is the step's rotation and R the max distance of a point from the axis. Rotation moves no point farther
/// than the chord from the half-way orientation. If the inflated object's path is free, the step is free at
/// every moment, so objects do not tunnel at any speed. If the chord is longer than R, the query inflates a
/// segment of the axis by R instead, to a capsule that contains the object in every orientation. Steps double
/// on success and halve on failure. An object that rotates in place and is free for a full rotation is free
/// for the whole duration. Without rotation, a single query gives the result.
///
/// An object that touches the scene at the start stops at once if its rotation moves a point by more than a
/// nanometre, even if the object moves away from the scene. Callers should therefore keep a gap. A stopped
/// object has a gap of up to tolerance_m.
///
/// Allocates a few hundred bytes in addition to the radar's memory.
TimeOfImpact time_of_impact(CyberRadar& radar, const TreeInstance& object, const RigidMotion& motion,
                            double duration_s, const RadarScene& scene,
                            const TimeOfImpactConfig& config = {});

}  // namespace roomradar
