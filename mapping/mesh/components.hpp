// components.hpp: connected components of a mesh, and removal of small ones.
#pragma once
#include <cstdint>
#include <functional>

#include "mapping/types/disjoint_sets.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns the connected components of the vertices, by shared triangles.
DisjointSets<std::uint32_t> components_of(const Mesh& mesh);

/// Returns a mesh of the given triangles and the vertices they use, in order of first use. The vertex indices
/// in `triangles` refer to `mesh`.
Mesh compacted(const Mesh& mesh, const std::vector<Triangle>& triangles);

/// Drops connected components (by shared vertices) with an area below min_component_area_m2, and unused
/// vertices.
/// @param is_cut  callback on a vertex index. True: the vertex's component may continue beyond this mesh, and
///                is kept regardless of its area. Empty: no component is cut
Mesh drop_small_components(const Mesh& mesh, float min_component_area_m2,
                           const std::function<bool(std::uint32_t)>& is_cut = {});

}  // namespace roomradar
