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

/// Simulates one substep of advance_together(). Advances each awake body by its dt_s, or until a surface
/// intersects it (MovingBody::crosses). Wakes sleeping bodies that the weight or impact of others would move.
/// @param results  out: one per body, in order
void simulate_substep(std::span<MovingBody> bodies, const PhysicsConfig& config, ContactSystem& system,
                      std::vector<SubstepResult>& results);

}  // namespace roomradar
