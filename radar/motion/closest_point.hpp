// closest_point.hpp: closest features of two meshes, and masks of surface kinds.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "radar/geometry/contact.hpp"

namespace roomradar {

/// Closest features of scene and object: a corner and its foot on a face, or two edges that pass each other.
struct ClosestPoint {
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();   ///< on the scene
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();  ///< unit, from point_world to the object
  double gap_m = 0.0;                                      ///< >= 0; 0: touching
  SurfaceKind kind = SurfaceKind::kNothing;
  std::uint32_t tree = 0;  ///< index of the scene's tree
};

/// Max points that one proximity query returns.
inline constexpr std::size_t kMaxClosestPoints = 24;

/// Bit mask of surface kinds.
using SurfaceKindMask = std::uint32_t;
constexpr SurfaceKindMask bit_of(SurfaceKind kind) {
  return SurfaceKindMask{1} << static_cast<unsigned>(kind);
}

}  // namespace roomradar
