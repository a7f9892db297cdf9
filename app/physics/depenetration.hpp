// depenetration.hpp: directions for depenetration from moving surfaces, and a test for engulfed bodies.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <initializer_list>
#include <span>

#include "app/physics/body.hpp"
#include "app/physics/collision_queries.hpp"
#include "app/physics/physics_config.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns true if the inferred backs of dynamic surfaces, queried by `back`, engulf the body: they overlap
/// it, along gravity and all depenetration directions by more than a pushing surface can enter in one step.
/// Callers then leave the backs out of the scene, since resolving such an overlap would throw the body.
bool is_engulfed(const Body& body, double dt_s, const DistanceQuery& back, const PhysicsConfig& config,
                 std::span<const Eigen::Vector3d> depenetration_directions_world);

/// Horizontal unit directions from a body to nearby moving surfaces: to the nearest vertex, and to the mean
/// of all vertices of the meshes within reach_m of centre_world. None, one or two.
struct PushDirections {
  int count = 0;
  std::array<Eigen::Vector3d, 2> direction_world{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  [[nodiscard]] std::span<const Eigen::Vector3d> span() const {
    return {direction_world.data(), static_cast<std::size_t>(count)};
  }
};
PushDirections depenetration_directions(std::initializer_list<const Mesh*> moving_world,
                                        const Eigen::Vector3d& centre_world, double reach_m,
                                        const Eigen::Vector3d& up_world = Eigen::Vector3d::UnitZ());

}  // namespace roomradar
