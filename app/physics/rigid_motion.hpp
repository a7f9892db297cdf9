// rigid_motion.hpp: one substep of the motion of rigid bodies that touch each other.
#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "app/physics/contact_system.hpp"
#include "app/physics/physics_config.hpp"
#include "app/physics/support.hpp"

namespace roomradar {

/// Simulates one substep of advance_together(): each active body by its dt_s, until a surface intersects it
/// (MovingBody::crosses). Sleeping bodies that the weight or the impact of others would move wake up.
/// @param results  out: one per body, in order
void simulate_substep(std::span<MovingBody> bodies, const PhysicsConfig& config, ContactSystem& system,
                      std::vector<SubstepResult>& results);

}  // namespace roomradar
