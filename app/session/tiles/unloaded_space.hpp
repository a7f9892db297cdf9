// unloaded_space.hpp: removes expected depth behind tiles that are not loaded, by casting rays.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Returns where a ray enters a box, as a multiple of `ray_world`, >= 0; infinite if it misses the box.
/// Source: Kay and Kajiya, Ray tracing complex scenes, SIGGRAPH 1986 (slabs).
double ray_entry(const Eigen::AlignedBox3d& box_world, const Eigen::Vector3d& from_world,
                 const Eigen::Vector3d& ray_world);

/// Sets a pixel's depth to 0 if its ray enters one of the boxes before it reaches that depth. A surface in
/// the box may be nearer than the depth, so the depth is unknown there.
/// @param boxes_world  bounding boxes of the surfaces of tiles that are not loaded
void hide_behind(std::span<const Eigen::AlignedBox3d> boxes_world, const Intrinsics& camera,
                 const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m);

}  // namespace roomradar
