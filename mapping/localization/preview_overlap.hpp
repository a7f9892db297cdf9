// preview_overlap.hpp: compares the depth of two keyframes.
#pragma once
#include <Eigen/Geometry>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Pixels of one preview, compared with another. Counts every fourth pixel of every fourth row.
struct PreviewOverlap {
  int valid = 0;    ///< pixels with depth of at most 4 m
  int same = 0;     ///< of these, those at the other's surface
  int through = 0;  ///< those in front of the other's surface: the other saw through them
};

/// Compares the depth of a keyframe with that of another.
/// @param T_to_from    relative pose of the two cameras
/// @param tolerance_m  max assumed error of T_to_from, added to the noise of the depth
PreviewOverlap compare_previews(const MapKeyframe& from, const MapKeyframe& to,
                                const Eigen::Isometry3d& T_to_from, double tolerance_m);

}  // namespace roomradar
