// body.hpp: a rigid body's state, and the report of one physics step.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "app/physics/body_material.hpp"
#include "app/physics/mass_properties.hpp"
#include "radar/geometry/contact.hpp"

namespace roomradar {

/// A rigid virtual object.
struct Body {
  std::string name;
  MassProperties mass;
  BodyMaterial material;  ///< friction and restitution; its mass is already in mass.mass_kg
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();            ///< of the centre of mass
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();  ///< right-handed
  bool asleep = false;
  /// Time for which the body has been supported and within PhysicsConfig::sleep_drift_m of
  /// sleep_pose_candidate.
  double sleep_timer_s = 0.0;
  Eigen::Isometry3d sleep_pose_candidate = Eigen::Isometry3d::Identity();
  /// Time for which the weight on the sleeping body would have set it in motion.
  double unbalanced_s = 0.0;
  /// Kind of the surface that supported the body when it last moved.
  SurfaceKind rests_on = SurfaceKind::kNothing;
  /// Another body that was in contact with this body when this body fell asleep.
  struct SupportingBody {
    const Body* on;
    /// Pose of `on` when this body fell asleep.
    Eigen::Isometry3d T_world_other;
  };
  std::vector<SupportingBody> supporting_bodies;
};

enum class StepStatus {
  kMoved,    ///< normal result, also for a body that stayed asleep or at rest
  kHeld,     ///< a radar query gave no usable result; both velocities are set to zero
  kInvalid,  ///< dt_s is negative or not finite, or the body's state is not finite; nothing changed
};

struct [[nodiscard]] StepReport {
  StepStatus status = StepStatus::kMoved;
  /// Number of impacts in the step. Simultaneous impacts on one kind of surface count once.
  int contacts = 0;
  std::array<int, kSurfaceKinds> contacts_by_kind{};  ///< `contacts` per surface kind
  int queries = 0;                                    ///< number of CollisionQueries::travel calls
  /// Penetration depth of the body into the scene before depenetration: the least depth along the tested
  /// directions, >= 0.
  double deepest_overlap_m = 0.0;
  double deepest_static_overlap_m = 0.0;  ///< deepest_overlap_m if the prescanned room causes it, else 0
  bool woke = false;                      ///< this step woke the body
};

/// Adds one contact with a surface of kind `touched` to `report`.
void note_contact(SurfaceKind touched, StepReport& report);

/// Returns an upper bound of the displacement of the body's points since the pose T_world_before. The bound
/// is the translation of the centre of mass plus the rotation angle times MassProperties::radius_m.
double strayed_m(const Body& body, const Eigen::Isometry3d& T_world_before);

/// Returns the centre of mass in the world.
Eigen::Vector3d centre_world(const Body& body);
/// Returns the inertia about the centre of mass, in world axes.
Eigen::Matrix3d inertia_world_m2(const Body& body);

/// Returns the constant angular velocity that gives the same rotation over time_s as torque-free rotation
/// that starts with angular_rad_s. Torque-free rotation conserves angular momentum, not angular velocity.
/// Integrates by a Runge-Kutta method of fourth order.
Eigen::Vector3d mean_free_spin(const Body& body, const Eigen::Vector3d& angular_rad_s, double time_s);

}  // namespace roomradar
