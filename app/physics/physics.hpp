// physics.hpp: rigid-body motion of a virtual object, with radar queries for contact.
#pragma once
#include <Eigen/Core>
#include <span>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// Advances `body` by dt_s: gravity, contact, Coulomb friction, sleep.
///
/// Each substep first finds the contacts within contact_margin_m (CollisionQueries::near). Contact impulses
/// cancel approach velocity (with restitution above bounce_mps), then support against gravity and apply
/// friction, without restitution. The body moves with the mean of the velocities before and after, for as
/// long as that motion is free of contact (CollisionQueries::free_time). The rest of the substep starts over
/// from the new pose. Hence nothing tunnels, moving or rotating, at any step size. Between contacts the path
/// is a parabola and angular momentum is conserved.
///
/// Bodies of probe.others receive the opposite impulse. Their velocity changes at once, their pose when they
/// are advanced themselves. Sleeping bodies wake if hit at 5 cm/s or more; slower contacts, such as an object
/// settling on them, would otherwise keep them awake. So weight alone does not tip a sleeping body.
///
/// If a surface has entered the body, the body is moved out first, by translation. A moving surface that
/// enters from the side instead pushes it at the deepest point, at the speed that covers this overlap in
/// dt_s, so the body slides, turns or tips. While a surface still intersects the body, the body moves without
/// rotation, by radar queries along its path.
///
/// @param dt_s   seconds since the last call, >= 0; 0 changes nothing
/// @param depenetration_directions_world  see depenetration_directions(); tried for the shortest
///                                        depenetration; may be empty
/// A sleeping body is tested only along gravity and depenetration_directions_world, and noise does not move
/// it. A body that fell asleep in contact with another body wakes when the other moves or disappears: it
/// follows, or tips if its support is withdrawn. A sleeping body with a non-zero velocity wakes. At most
/// max_advance_s is simulated per call.
StepReport advance(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
                   std::span<const Eigen::Vector3d> depenetration_directions_world = {});

}  // namespace roomradar
