// rigid_motion.hpp: one substep of rigid bodies in contact with each other.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "app/physics/body.hpp"
#include "app/physics/contact_system.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

struct [[nodiscard]] SubstepResult {
  bool is_held_up = false;   ///< a surface within 60 degrees of level, or all contacts together, support it
  bool is_balanced = false;  ///< supported, and would stay at rest if all bodies stopped
  /// Kind of the supporting surface with the greatest normal impulse.
  SurfaceKind rests_on = SurfaceKind::kNothing;
  std::vector<const Body*> touches{};  ///< other bodies in contact
};

/// Sets is_held_up, rests_on and touches of each active body from the impulses of the support solve. A body
/// is held up by surfaces within 60 degrees of level. A body is also held up if all contacts together bear at
/// least 90 % of its weight, as at a keystone.
/// @param up_world  unit, against gravity. Zero without gravity; then nothing is held up
/// @param results   one per body, in order. Other fields are unchanged
void note_support(std::span<const MovingBody> bodies, const PhysicsConfig& config,
                  const Eigen::Vector3d& up_world, const ContactSystem& system,
                  std::vector<SubstepResult>& results);

/// Adds the impacts of the last solve to the bodies' reports. Simultaneous impacts of a body on one kind of
/// surface count once.
void count_impacts(std::span<const MovingBody> bodies, const ContactSystem& system);

/// Simulates one substep of advance_together(). Advances each awake body by its dt_s, or until a surface
/// intersects it (MovingBody::crosses). Wakes sleeping bodies that the weight or impact of others would move.
/// @param results  out: one per body, in order
void simulate_substep(std::span<MovingBody> bodies, const PhysicsConfig& config, ContactSystem& system,
                      std::vector<SubstepResult>& results);

}  // namespace roomradar
