// surface_parts.hpp: extracts a large map's full surface in parts, which bounds the memory. Private to
// surface_extraction.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

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
