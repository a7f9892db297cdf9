// hatched_patch.hpp: hatches the level patch on which an object rests at the border of unknown space.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A level disc in the world.
struct HatchedPatch {
  Eigen::Vector3d middle_world = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Draws orange stripes, 1 cm wide and 2 cm apart, over the pixels that see a patch.
/// @param camera        camera of the picture
/// @param real_depth_m  depth of real surfaces, of the picture's size; hides patches behind it, 0 hides
/// nothing Patches behind the camera, with a radius that is not > 0, or not finite are skipped.
void hatch(std::span<const HatchedPatch> patches, const Intrinsics& camera,
           const Eigen::Isometry3d& T_world_camera, const DepthImage& real_depth_m, ColourImage& picture);

}  // namespace roomradar
