// closest_point.hpp: a pair of closest features of two meshes, and bit masks of surface kinds.
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

#include "radar/geometry/contact.hpp"

namespace roomradar {

/// Closest features of scene and object: a vertex and its projection onto a face, or the nearest points of
/// two edges.
struct ClosestPoint {
  /// Point on the scene, m.
  Eigen::Vector3d point_world = Eigen::Vector3d::Zero();
  /// Unit vector from point_world to the object.
  Eigen::Vector3d normal_world = Eigen::Vector3d::Zero();
  /// Distance between the features, m, >= 0; 0 if they touch.
  double gap_m = 0.0;
  SurfaceKind kind = SurfaceKind::kNothing;
  /// Index of the tree in RadarScene::trees.
  std::uint32_t tree = 0;
};

/// Max number of points per tree that one proximity query returns.
inline constexpr std::size_t kMaxClosestPoints = 24;

/// Bit mask of surface kinds, see bit_of().
using SurfaceKindMask = std::uint32_t;
constexpr SurfaceKindMask bit_of(SurfaceKind kind) {
  return SurfaceKindMask{1} << static_cast<unsigned>(kind);
}

}  // namespace roomradar
