// body.hpp: a rigid body, its physics settings, and what one step asks and reports.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "app/physics/mass_properties.hpp"
#include "radar/geometry/contact.hpp"
#include "radar/motion/proximity.hpp"
#include "radar/motion/time_of_impact.hpp"

namespace roomradar {

/// A rigid virtual object.
struct Body {
  std::string name;
  MassProperties mass;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();            ///< of the centre of mass
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();  ///< angular velocity, right-handed
  bool asleep = false;
  double sleep_timer_s =
      0.0;  ///< sleep timer: time supported while within sleep_drift_m of sleep_pose_candidate
  Eigen::Isometry3d sleep_pose_candidate = Eigen::Isometry3d::Identity();
  SurfaceKind rests_on = SurfaceKind::kNothing;  ///< surface kind that supported it when last moved
  /// Bodies in contact when this one fell asleep, and their poses then.
  struct SupportingBody {
    const Body* on;
    Eigen::Isometry3d T_world_other;
  };
  std::vector<SupportingBody> supporting_bodies;
};

struct PhysicsConfig {
  Eigen::Vector3d gravity_world_mps2{0.0, 0.0, -9.81};
  /// Fraction of the normal velocity returned by an impact, 0..1; 0 for impacts below bounce_mps.
  double restitution = 0.0;
  double bounce_mps = 0.3;  ///< min impact speed for restitution
  double friction = 0.5;    ///< Coulomb's coefficient, >= 0
  /// Rolling resistance: max torque per normal force and contact offset, >= 0. A ball that rolls at 0.5 m/s
  /// stops after 0.9 m.
  double rolling = 0.02;
  /// Gap kept to surfaces, in addition to the radar's uncertainty (lower_m is less than the true distance). A
  /// body in exact touch could not tell resting from overlap.
  double contact_margin_m = 0.001;
  double max_step_s = 1.0 / 60.0;  ///< max substep, exceeded by 5 % at most
  /// Max time simulated per call; the rest is dropped (a stalled camera must not launch objects).
  double max_advance_s = 0.5;
  int max_slides = 16;           ///< max stops per substep; the rest of the substep is then dropped
  double sleep_drift_m = 0.012;  ///< max motion of any point over sleep_after_s to fall asleep on a support
  double sleep_after_s = 0.3;
  double wake_gap_m = 0.012;      ///< asleep: wakes if its support sinks by more; sensor noise is some mm
  double wake_moved_m = 0.001;    ///< asleep: wakes if another body it touched moves by more than this
  double wake_overlap_m = 0.008;  ///< asleep: wakes and moves out if support or hand enters by more than this
  double overlap_allowed_m = 0.001;    ///< awake: overlap up to this is left uncorrected
  double max_depenetration_mps = 1.0;  ///< max depenetration speed, and max speed of a pushing hand
  double max_speed_mps = 20.0;
  double max_angular_rad_s = 60.0;  ///< max angular velocity, about ten turns per second
};
/// Finds the first contact of the object at T_world_object along a unit direction, within distance_m. Calls
/// CyberRadar::query() with the object's mesh and the frame's scene, or an analytic room in tests.
using DistanceQuery = std::function<Contact(const Eigen::Isometry3d& T_world_object,
                                            const Eigen::Vector3d& direction_world, double distance_m)>;

/// The body that one of the scene's trees belongs to.
struct SceneBody {
  Body* body = nullptr;     ///< null: the tree is not a body
  double mass_ratio = 0.0;  ///< mass ratio as SolverBody::gives; 0: constrained, such as in a user's hand
};

/// Collision queries of a moving body: its own mesh against the frame's scene.
struct CollisionQueries {
  DistanceQuery travel;
  /// As ProximityQuery::near() and ProximityQuery::free_time().
  std::function<SurfaceKindMask(const Eigen::Isometry3d& T_world_object, double reach_m,
                                SurfaceKindMask left_out, std::vector<ClosestPoint>& points)>
      near;
  std::function<FreeTime(const Eigen::Isometry3d& T_world_object, const RigidMotion& motion,
                         double duration_s, double keep_m, SurfaceKindMask left_out)>
      free_time;
  /// For the scene's first trees, by index; later trees are static.
  std::span<const SceneBody> others = {};
};
enum class StepStatus {
  kMoved,    ///< or free to move, whether asleep or not
  kHeld,     ///< the radar returned no usable result: stays in place with zero velocity
  kInvalid,  ///< dt or the body is not finite: nothing changed
};

struct [[nodiscard]] StepReport {
  StepStatus status = StepStatus::kMoved;
  int contacts = 0;  ///< number of surface kinds touched, summed over all stops
  std::array<int, kSurfaceKinds> contacts_by_kind{};  ///< the same, by kind of surface
  int queries = 0;                                    ///< number of radar queries along a direction
  /// Deepest overlap before it was resolved, along the shortest depenetration direction, >= 0.
  double deepest_overlap_m = 0.0;
  double deepest_static_overlap_m = 0.0;  ///< the same, with the prescanned room only
  bool woke = false;                      ///< was asleep before, and is awake now
};

}  // namespace roomradar
