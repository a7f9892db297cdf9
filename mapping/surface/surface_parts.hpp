// surface_parts.hpp: extracts a large map's full surface in parts, which bounds the memory.
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

/// Returns the centre of a triangle, in the world. The vertices of a full surface are on a grid of 2^-17 m,
/// so their sum is exact, and all parts that have the triangle agree.
Eigen::Vector3d centre_world(const Mesh& mesh, const Triangle& triangle);

/// Divides the world into boxes along planes between voxels, such that each box has at most most_bricks (>=
/// 1) bricks with a sample (see tsdf_bricks.hpp), or only one. Each point is in one box: a box contains its
/// lower sides, not its upper ones. An empty map has one box.
std::vector<Eigen::AlignedBox3d> divide(const StaticMap& map, std::size_t most_bricks);

/// Joins the parts of a surface. From extract(box), takes the triangles with a centre in the box. They must
/// be bit-identical to those of the whole surface, as far as the box reaches. Vertices that triangles of
/// other boxes use are merged where they are equal. The result is the whole surface, with the triangles in
/// another order.
Mesh join_parts(const std::vector<Eigen::AlignedBox3d>& boxes,
                const std::function<Mesh(const Eigen::AlignedBox3d&)>& extract);

}  // namespace roomradar
