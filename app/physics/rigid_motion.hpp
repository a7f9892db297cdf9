// rigid_motion.hpp: one substep of rigid bodies in contact with each other.
#pragma once
#include <span>

#include "app/physics/contact_system.hpp"
#include "app/physics/moving_body.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// Simulates one substep of advance_together(). Advances each awake body by its dt_s, or until a surface
/// intersects it (MovingBody::crosses). Wakes sleeping bodies that the weight or impact of others would move.
/// Sets MovingBody::result and `near`.
void simulate_substep(std::span<MovingBody> bodies, const PhysicsConfig& config, ContactSystem& system);

}  // namespace roomradar
