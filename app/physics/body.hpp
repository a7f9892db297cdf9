// body.hpp: a rigid body, its centre and inertia in the world, and the report of one step.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "app/physics/mass_properties.hpp"
#include "radar/geometry/contact.hpp"

namespace roomradar {

/// A rigid virtual object.
struct Body {
  std::string name;
  MassProperties mass;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();            ///< of the centre of mass
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();  ///< right-handed
  bool asleep = false;
  double sleep_timer_s = 0.0;  ///< time supported and within sleep_drift_m of sleep_pose_candidate
  Eigen::Isometry3d sleep_pose_candidate = Eigen::Isometry3d::Identity();
  SurfaceKind rests_on = SurfaceKind::kNothing;  ///< surface kind that supported it in its last motion
  /// Bodies in contact when this one fell asleep, and their poses then.
  struct SupportingBody {
    const Body* on;
    Eigen::Isometry3d T_world_other;
  };
  std::vector<SupportingBody> supporting_bodies;
};

enum class StepStatus {
  kMoved,    ///< moved, or was free to move; also if asleep
  kHeld,     ///< the radar returned no usable result: body stopped in place
  kInvalid,  ///< dt or the body is not finite: nothing changed
};

struct [[nodiscard]] StepReport {
  StepStatus status = StepStatus::kMoved;
  int contacts = 0;  ///< number of surface kinds touched, summed over the step's stops at contacts
  std::array<int, kSurfaceKinds> contacts_by_kind{};  ///< the same, by kind of surface
  int queries = 0;                                    ///< number of radar queries along a direction
  /// Deepest overlap before depenetration, along the shortest depenetration direction, >= 0.
  double deepest_overlap_m = 0.0;
  double deepest_static_overlap_m = 0.0;  ///< the same, with the prescanned room only
  bool woke = false;                      ///< was asleep before this step, and is awake now
};

/// Counts a contact with a surface of this kind in `report`.
void note_contact(SurfaceKind touched, StepReport& report);

/// Makes the rotation orthonormal again after accumulated rounding.
void make_orthonormal(Eigen::Isometry3d& T);

/// Returns an upper bound of how far any point of the body moved since T_world_before: translation of the
/// centre of mass plus rotation angle times radius.
double strayed_m(const Body& body, const Eigen::Isometry3d& T_world_before);

/// Returns the centre of mass in the world.
Eigen::Vector3d centre_world(const Body& body);
/// Returns the inertia about the centre of mass, in world axes.
Eigen::Matrix3d inertia_world_m2(const Body& body);

}  // namespace roomradar
