// flat_faces.hpp: finds the triangles of a closed mesh that are within flat faces.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "radar/geometry/half_edges.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// Returns for each triangle whether it is within a flat face (see TriangleTree).
/// @param edges   from half_edges_of()
/// @param flat_m  a triangle joins a face if its corners are at most this far from the face's plane; at most
///                twice this far once the face is complete
std::vector<bool> find_within_flat_faces(const std::vector<Triangle>& triangles,
                                         const std::vector<Eigen::Vector3f>& vertices,
                                         const std::vector<HalfEdge>& edges, double flat_m);

/// Sets TreeNode::within_faces of all nodes.
/// @param within  per triangle, in the tree's order
/// @param nodes   children come after their parents
void mark_flat_faces(const std::vector<bool>& within, std::vector<TreeNode>& nodes);

}  // namespace roomradar
