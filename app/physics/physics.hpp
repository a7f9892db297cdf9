// physics.hpp: rigid-body motion of virtual objects; contacts are found by Cyber Radar queries.
#pragma once
#include <Eigen/Core>
#include <span>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_system.hpp"
#include "app/physics/moving_body.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// Returns the max speed at which surfaces push the body or move it out of an overlap.
double max_push_mps(const AdvancedBody& advanced, const PhysicsConfig& config);

/// Advances bodies under gravity, contacts and Coulomb friction, and puts them to sleep or wakes them.
///
/// Each substep first finds the contacts within 1.5 contact_margin_m (CollisionQueries::near). A first solve
/// cancels approach velocity, with restitution for impacts faster than bounce_mps. A second solve adds
/// gravity, support and friction, without restitution. Both solve each connected component of bodies in
/// contact as one system, so a body bears the weight of everything on it. Each body then moves with the mean
/// of its velocities before and after the second solve, all bodies simultaneously, each until its first time
/// of impact (CollisionQueries::free_time). Bodies that touch each other stop at the time of impact. The
/// other bodies continue, with the stopped bodies as obstacles at rest. Bodies whose paths cannot intersect
/// are independent. The remaining time of a stopped body's substep is simulated in the same way from the new
/// poses. Hence neither translation nor rotation tunnels, at any step size. No body enters another. A body
/// that hardly moves in four motions, jammed between others, stays for the rest of the substep. Between
/// contacts, the path is a parabola and angular momentum is conserved.
///
/// Bodies in the scene of AdvancedBody::probe that are not advanced in this call receive the opposite
/// impulses. The velocities of these bodies change at once, their poses only when they are advanced.
///
/// A sleeping body wakes if another body hits it faster than 5 cm/s. It also wakes if the weight on it would
/// set it in motion, unless it sleeps on a dynamic surface.
///
/// If a surface overlaps a body before the step, the body is first translated out of the overlap. If a
/// dynamic surface overlaps the body from the side, the surface instead pushes the body at their contacts, at
/// the speeds that remove the overlap in dt_s; see push_contacts(). The body then slides, rotates or tips.
/// While a surface other than the pushing one intersects a body, the body is translated without rotation, by
/// radar queries along its path.
///
/// Apart from contacts with moving bodies, a sleeping body is tested only along gravity and
/// depenetration_directions_world; if it overlaps along gravity by more than 3 mm, also along four horizontal
/// directions. Overlaps up to wake_overlap_m, such as from sensor noise, do not move it. For moving dynamic
/// surfaces, this limit is reduced by the distance that they travel in dt_s. A body that fell asleep in
/// contact with another body wakes when that other body moves by more than wake_moved_m or disappears. A
/// sleeping body with a non-zero velocity wakes. At most max_advance_s is simulated per call.
/// @param system  pass the same object in each call; its impulses warm-start the next solve
void advance_together(std::span<AdvancedBody> bodies, const PhysicsConfig& config, ContactSystem& system);

/// Advances one body by dt_s; see advance_together().
StepReport advance(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
                   std::span<const Eigen::Vector3d> depenetration_directions_world = {});

}  // namespace roomradar
