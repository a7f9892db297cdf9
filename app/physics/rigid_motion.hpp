// rigid_motion.hpp: one substep of rigid-body motion.
#pragma once
#include <optional>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_solver.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// A contact at which a dynamic surface pushes the body throughout a step. All other contacts with dynamic
/// surfaces are ignored in the step, since dynamic surfaces intersect the body until the push ends.
struct Push {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, towards the body
  double speed_mps = 0.0;  ///< min speed of the body at point_world along the normal
  SurfaceKind touched = SurfaceKind::kDynamic;
};

/// Returns true for dynamic surfaces and their inferred backs.
constexpr bool is_moving_surface(SurfaceKind kind) {
  return kind == SurfaceKind::kDynamic || kind == SurfaceKind::kInferredBack;
}

/// Cosine of 60 degrees, the max slope of a surface that supports a body.
inline constexpr double kSupportCosine = 0.5;

struct [[nodiscard]] SubstepResult {
  /// True if a surface other than the pushing one intersects the body. The remaining left_s were not
  /// simulated.
  bool crosses = false;
  double left_s = 0.0;       ///< time of the substep that was not simulated; > 0 only if `crosses`
  bool is_held_up = false;   ///< a contact with a normal within 60 degrees of up carries load
  bool is_balanced = false;  ///< supported, and would stay at rest if it were at rest
  /// Kind of the supporting surface with the greatest normal impulse.
  SurfaceKind rests_on = SurfaceKind::kNothing;
};

/// Buffers for the contacts of a moving body, reused by the substeps of a step.
struct RigidScratch {
  std::vector<ClosestPoint> near;
  std::vector<SolverContact> contacts;
  std::vector<SurfaceKind> kinds;
  std::vector<SolverBody> others;  ///< solver state of the bodies in contact
  std::vector<Body*> bodies;       ///< body of each entry of `others`
};

/// Simulates one substep of advance(), of length dt_s.
/// @param report  the substep's contacts are added
SubstepResult simulate_substep(Body& body, double dt_s, const CollisionQueries& probe,
                               const PhysicsConfig& config, const std::optional<Push>& push,
                               RigidScratch& scratch, StepReport& report);

}  // namespace roomradar
