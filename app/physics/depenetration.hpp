// depenetration.hpp: depenetration directions from dynamic surfaces, and a test for engulfed bodies.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <vector>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/contact_system.hpp"
#include "app/physics/physics_config.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns true if the inferred backs of dynamic surfaces engulf the body: the backs overlap the body along
/// gravity or a depenetration direction. In addition, each such penetration depth must exceed
/// max_depenetration_mps * dt_s + wake_overlap_m. Callers then omit the backs from the scene, since resolving
/// such deep overlaps would throw the body.
bool is_engulfed(const Body& body, double dt_s, const DistanceQuery& back, const PhysicsConfig& config,
                 std::span<const Eigen::Vector3d> depenetration_directions_world);

/// An overlap of a body with a surface along a direction.
struct DirectedOverlap {
  double depth_m = 0.0;                                       ///< 0: none
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();  ///< unit, towards the surface
  Contact contact;
};

/// Returns the contacts at which dynamic surfaces push a body out of an overlap. The contacts are the closest
/// features of the body after a translation out of the overlap. Each contact's speed is the normal speed that
/// this translation needs there. Hence the pushed body may rotate, but not into another part of the surfaces.
/// If the translated body still intersects a surface, the only contact is that of the overlap.
/// @param push_m  displacement by the push during dt_s, at most overlap.depth_m plus the contact margin
std::vector<Push> push_contacts(const Body& body, const DirectedOverlap& overlap, double push_m, double dt_s,
                                const CollisionQueries& queries, const PhysicsConfig& config);

/// Up to three unit directions from a body towards dynamic surfaces near it. Two are horizontal: to the
/// surfaces' nearest vertex, and to the mean of their vertices within reach_m. The third is the direction
/// from which the surfaces move.
struct PushDirections {
  int count = 0;
  std::array<Eigen::Vector3d, 3> direction_world{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                                 Eigen::Vector3d::Zero()};
  void add(const Eigen::Vector3d& direction) {
    direction_world[static_cast<std::size_t>(count++)] = direction;
  }
  [[nodiscard]] std::span<const Eigen::Vector3d> span() const {
    return {direction_world.data(), static_cast<std::size_t>(count)};
  }
};
/// Returns the directions from centre_world to the vertices of the meshes moving_world. Omits a direction
/// within about 11 degrees of vertical, and a second direction within about 14 degrees of the first.
PushDirections depenetration_directions(std::initializer_list<const Mesh*> moving_world,
                                        const Eigen::Vector3d& centre_world, double reach_m,
                                        const Eigen::Vector3d& up_world = Eigen::Vector3d::UnitZ());

}  // namespace roomradar
