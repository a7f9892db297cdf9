// half_edges.hpp: half-edges of a triangle mesh, and whether they enclose a volume.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A triangle's side, on an edge between two positions.
struct HalfEdge {
  std::uint64_t edge;  ///< key of the undirected edge; equal for all its half-edges
  std::uint32_t side;  ///< 3 * triangle + index of the side's first corner
  int sense;           ///< +1 or -1: direction along the edge
};

/// Returns a number per vertex, equal for vertices at the same position. Vertices that are not finite get 0.
std::vector<std::uint32_t> numbers_by_place(const std::vector<Eigen::Vector3f>& vertices);

/// Returns the half-edges sorted by edge, without those between vertices at the same position.
/// @param number  from numbers_by_place()
std::vector<HalfEdge> half_edges_of(const std::vector<Triangle>& triangles,
                                    const std::vector<std::uint32_t>& number);

/// See TriangleTree::is_closed(). Needs at least one triangle.
/// @param number  from numbers_by_place()
/// @param edges   from half_edges_of()
bool encloses_a_volume(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
                       const std::vector<std::uint32_t>& number, const std::vector<HalfEdge>& edges);

}  // namespace roomradar
