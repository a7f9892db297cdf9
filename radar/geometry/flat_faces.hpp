// flat_faces.hpp: finds the triangles of a closed mesh that are within flat faces.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "radar/geometry/half_edges.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// Returns, per triangle, true if all its neighbours belong to the same flat face (see TriangleTree).
/// @param edges   result of half_edges_of() for these triangles
/// @param flat_m  flatness tolerance: a triangle joins a face if its corners are at most this far from the
///                plane of the face; in the complete face, they are at most twice this far from its plane
std::vector<bool> find_within_flat_faces(const std::vector<Triangle>& triangles,
                                         const std::vector<Eigen::Vector3f>& vertices,
                                         const std::vector<HalfEdge>& edges, double flat_m);

/// Sets TreeNode::within_faces of all nodes.
/// @param within  by triangle, in the tree's order: true if it is within a flat face
/// @param nodes   children must come after their parents
void mark_flat_faces(const std::vector<bool>& within, std::vector<TreeNode>& nodes);

}  // namespace roomradar
