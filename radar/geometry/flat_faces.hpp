// flat_faces.hpp: finds the triangles in the interior of a closed mesh's flat faces.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "radar/geometry/half_edges.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// Returns, per triangle, true if the triangle and all its neighbours belong to one flat face (see
/// TriangleTree).
/// @param edges   result of half_edges_of() for these triangles
/// @param flat_m  flatness tolerance, m. A triangle joins a face if its vertices are at most flat_m from the
///                plane fitted to the face so far, and its normal is within 8 degrees of the plane's.
///                Vertices of the complete face are at most 2 flat_m from its plane
std::vector<bool> find_within_flat_faces(const std::vector<Triangle>& triangles,
                                         const std::vector<Eigen::Vector3f>& vertices,
                                         const std::vector<HalfEdge>& edges, double flat_m);

/// Sets TreeNode::within_faces of all nodes.
/// @param within  result of find_within_flat_faces(), in the tree's order of triangles
/// @param nodes   children must come after their parents
void mark_flat_faces(const std::vector<bool>& within, std::vector<TreeNode>& nodes);

}  // namespace roomradar
