// hatched_patch.hpp: draws hatching under objects that rest on the frontier of unknown space.
#pragma once
#include <Eigen/Geometry>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// A horizontal disc in the world to be hatched.
struct HatchedPatch {
  Eigen::Vector3d middle_world = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Draws orange stripes, 1 cm wide with gaps of 1 cm, over the pixels in which a patch is visible. Skips
/// patches that are behind the camera, have a radius <= 0 or are not finite.
/// @param real_depth_m  depth of real surfaces, with the size of `picture`. Surfaces hide patches that are
///                      more than 3 cm farther away. Depth 0 hides nothing
void hatch(std::span<const HatchedPatch> patches, const Intrinsics& camera,
           const Eigen::Isometry3d& T_world_camera, const DepthImage& real_depth_m, ColourImage& picture);

}  // namespace roomradar
