// rigid_motion.hpp: one substep of rigid-body motion, from contact to contact.
#pragma once
#include <optional>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_solver.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// A contact through which a moving surface pushes the body throughout a step. Other contacts with moving
/// surfaces are ignored in this step, since these surfaces still intersect the body.
struct Push {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, towards the body
  double speed_mps = 0.0;                                  ///< min speed of the body's point along the normal
  SurfaceKind touched = SurfaceKind::kDynamic;
};

constexpr bool is_moving_surface(SurfaceKind kind) {
  return kind == SurfaceKind::kDynamic || kind == SurfaceKind::kInferredBack;
}

inline constexpr double kSupportCosine = 0.5;  ///< surfaces within 60 degrees of horizontal support a body

struct [[nodiscard]] SubstepResult {
  /// A surface other than the pushing one intersects the body, so the rest of the substep was not simulated.
  bool crosses = false;
  double left_s = 0.0;       ///< time that was not simulated; > 0 only if `crosses`
  bool is_held_up = false;   ///< supported: a contact's normal is within 60 degrees of up
  bool is_balanced = false;  ///< supported, and would not start to move from rest
  SurfaceKind rests_on = SurfaceKind::kNothing;
};

/// Scratch: contacts of a moving body, reused between the substeps of a step.
struct RigidScratch {
  std::vector<ClosestPoint> near;
  std::vector<SolverContact> contacts;
  std::vector<SurfaceKind> kinds;
  std::vector<SolverBody> others;  ///< solver state of the bodies in contact
  std::vector<Body*> bodies;       ///< the bodies of `others`, by the same index
};

/// Simulates one substep of advance().
/// @param report  the substep's contacts and queries are added
SubstepResult simulate_substep(Body& body, double dt_s, const CollisionQueries& probe,
                               const PhysicsConfig& config, const std::optional<Push>& push,
                               RigidScratch& scratch, StepReport& report);

}  // namespace roomradar
