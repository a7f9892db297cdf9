// components.hpp: connected components of a mesh, and removal of small ones.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "mapping/types/disjoint_sets.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns the connected components of the vertices, by shared triangles.
DisjointSets<std::uint32_t> components_of(const Mesh& mesh);

/// Removes the vertices that no triangle uses, and puts the others in order of first use. Returns each
/// vertex's index before.
std::vector<std::uint32_t> drop_unused_vertices(Mesh& mesh);

/// Drops connected components (by shared vertices) with an area below min_component_area_m2, and unused
/// vertices.
/// @param is_cut  callback on a vertex's position in the world frame, m. True: the vertex's component may
///                continue beyond this mesh, and is kept regardless of its area. Empty: no component is cut
Mesh drop_small_components(Mesh mesh, float min_component_area_m2,
                           const std::function<bool(const Eigen::Vector3d&)>& is_cut = {});

}  // namespace roomradar
