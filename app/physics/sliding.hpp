// sliding.hpp: motion of a body without rotation, by radar queries along its path.
#pragma once
#include <Eigen/Core>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/physics_config.hpp"

namespace roomradar {

/// Cosine of 60 degrees, the max slope of a surface that supports a body.
inline constexpr double kSupportCosine = 0.5;
/// Reach of the proximity queries that find which surfaces cross a body, m.
inline constexpr double kTouching_m = 1e-6;

/// Returns probe.travel() from the body's pose. Replaces a normal that is missing or does not face the body
/// by -direction_world. If the result is not usable, stops the body and sets StepStatus::kHeld.
/// @param direction_world  unit
Contact query_travel(Body& body, const Eigen::Vector3d& direction_world, double distance_m,
                     const CollisionQueries& probe, StepReport& report);

/// Returns the distance, m, at most distance_m, by which a body that surfaces overlap can be translated until
/// its first contact. Ignores other bodies that cross this body, and surfaces of the kinds that cross or
/// overlap it.
/// @param direction_world  unit
/// @param overlapping      kinds of surfaces that overlap the body, perhaps without crossing it
double free_past_overlaps_m(const Body& body, const Eigen::Vector3d& direction_world, double distance_m,
                            SurfaceKindMask overlapping, const CollisionQueries& probe,
                            const PhysicsConfig& config);

/// Moves the body for dt_s under gravity, without rotation. Used for bodies that a surface intersects, where
/// contact impulses have no meaning. At each contact, the body loses its velocity into the surface, with
/// restitution and friction. It moves along the crease of two surfaces, and stops between three.
/// @return true if a surface within 60 degrees of level supported it
bool slide(Body& body, double dt_s, const CollisionQueries& probe, const PhysicsConfig& config,
           StepReport& report);

}  // namespace roomradar
