// physics.hpp: rigid-body motion of a virtual object, with Cyber Radar queries for contacts.
#pragma once
#include <Eigen/Core>
#include <span>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// Advances `body` by dt_s under gravity, contacts and Coulomb friction, and puts it to sleep or wakes it.
///
/// Each substep first finds the contacts within contact_margin_m (CollisionQueries::near). A first solve
/// cancels approach velocity, with restitution for impacts faster than bounce_mps. A second solve adds
/// gravity, support and friction, without restitution. The body then moves with the mean of its velocities
/// before and after the second solve, until that motion would reach a contact (CollisionQueries::free_time).
/// The remaining time of the substep is simulated in the same way from the new pose. Hence neither
/// translation nor rotation tunnels, at any step size. Between contacts, the path is a parabola and angular
/// momentum is conserved.
///
/// Bodies of probe.others receive opposite impulses. An impulse changes their velocity at once; their pose
/// changes when they are advanced themselves. A sleeping body wakes if it is hit faster than 5 cm/s. Slower
/// contacts do not move a sleeping body, so the weight of an object placed on it does not tip it.
///
/// If a surface overlaps the body before the step, the body is first translated out of the overlap. If a
/// dynamic surface overlaps it from the side, the contact point is instead pushed at the speed that removes
/// the overlap in dt_s. The body then slides, rotates or tips. While a surface other than the pushing one
/// intersects the body, the body moves without rotation, by radar queries along its path.
///
/// @param dt_s   seconds since the last call, >= 0; 0 changes nothing
/// @param depenetration_directions_world  directions towards dynamic surfaces, see
///                                        depenetration_directions(); may be empty
///
/// A sleeping body is tested only along gravity and depenetration_directions_world. Overlaps up to
/// wake_overlap_m, such as from sensor noise, do not move it. A body that fell asleep in contact with another
/// body wakes when that other body moves by more than wake_moved_m or disappears. A sleeping body with a
/// non-zero velocity wakes. At most max_advance_s is simulated per call.
StepReport advance(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
                   std::span<const Eigen::Vector3d> depenetration_directions_world = {});

}  // namespace roomradar
