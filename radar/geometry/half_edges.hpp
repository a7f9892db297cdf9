// half_edges.hpp: half-edges of a triangle mesh, and a test for closed meshes.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// One side of a triangle, as a directed edge between two vertex positions.
struct HalfEdge {
  std::uint64_t edge;  ///< key of the undirected edge; equal for all its half-edges
  std::uint32_t side;  ///< 3 * triangle + index (0 to 2) of the side's first vertex
  int sense;           ///< +1 or -1: direction of the side along the undirected edge
};

/// Returns one number per vertex. Vertices at the same position get the same number. Vertices that are not
/// finite get 0.
std::vector<std::uint32_t> numbers_by_place(const std::vector<Eigen::Vector3f>& vertices);

/// Returns the half-edges of all triangles, sorted by edge. Omits half-edges whose two vertices have the same
/// position.
/// @param number  result of numbers_by_place()
std::vector<HalfEdge> half_edges_of(const std::vector<Triangle>& triangles,
                                    const std::vector<std::uint32_t>& number);

/// Returns false if some edge is certainly not used equally often in both directions, so that the mesh is not
/// closed. O(n), without sorting. Vertices of the triangles must be finite.
bool may_be_closed(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices);

/// Returns true if the mesh is closed, as defined at TriangleTree::is_closed(). Needs at least one triangle.
/// @param number  result of numbers_by_place()
/// @param edges   result of half_edges_of()
bool encloses_a_volume(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector3f>& vertices,
                       const std::vector<std::uint32_t>& number, const std::vector<HalfEdge>& edges);

}  // namespace roomradar
