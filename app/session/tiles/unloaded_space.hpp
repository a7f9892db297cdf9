// unloaded_space.hpp: removes expected depth that lies behind tiles that are not loaded.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Sets the depth to 0 where a pixel's ray enters one of the boxes before it reaches that depth. A surface in
/// the box may be nearer than the depth, so nothing is known there.
/// @param boxes_world  bounding boxes of the surfaces of tiles that are not loaded
/// @param camera       of the image
void hide_behind(std::span<const Eigen::AlignedBox3d> boxes_world, const Intrinsics& camera,
                 const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m);

}  // namespace roomradar
