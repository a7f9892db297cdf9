// surface_parts.hpp: a large map's surface is extracted in parts, which bounds the memory.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns the box with each side moved outwards by by_m.
inline Eigen::AlignedBox3d grown(const Eigen::AlignedBox3d& box, double by_m) {
  return {box.min() - Eigen::Vector3d::Constant(by_m), box.max() + Eigen::Vector3d::Constant(by_m)};
}

/// Part of a map's surface: the triangles with a centre in one box.
struct SurfacePart {
  Mesh mesh;
  std::vector<bool> on_seam;  ///< per vertex: true if triangles of other parts use it, too
};

/// Returns the mesh's triangles with a centre in the box. The vertices of a full surface are on a grid of
/// 2^-17 m, so their sum is exact, and all parts that have a triangle agree on its centre.
SurfacePart part_in(const Eigen::AlignedBox3d& box_world, Mesh mesh);

/// Divides the world into boxes along planes between voxels, such that each box has at most most_bricks (>=
/// 1) bricks with a sample (see tsdf_bricks.hpp), or only one. Each point is in one box: a box contains its
/// lower sides, not its upper ones. An empty map has one box.
std::vector<Eigen::AlignedBox3d> divide(const StaticMap& map, std::size_t most_bricks);

/// Extracts the part of each box and joins them. Vertices on seams are merged where they are equal.
Mesh join_parts(const std::vector<Eigen::AlignedBox3d>& boxes,
                const std::function<SurfacePart(const Eigen::AlignedBox3d&)>& extract);

}  // namespace roomradar
