// preview_overlap.hpp: compares the depth of two keyframes.
#pragma once
#include <Eigen/Geometry>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Pixel counts of one preview (a keyframe's downsampled depth image) compared with another, over every
/// fourth pixel of every fourth row.
struct PreviewOverlap {
  int valid = 0;    ///< number of pixels with depth of at most 4 m
  int same = 0;     ///< number of valid pixels on the other preview's surface
  int through = 0;  ///< number of valid pixels in front of that surface: the other camera saw through them
};

/// Compares the depth of a keyframe with that of another.
/// @param T_to_from    relative pose of the two cameras
/// @param tolerance_m  max assumed error of T_to_from, added to the noise of the depth
PreviewOverlap compare_previews(const MapKeyframe& from, const MapKeyframe& to,
                                const Eigen::Isometry3d& T_to_from, double tolerance_m);

}  // namespace roomradar
