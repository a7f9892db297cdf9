// components.hpp: connected components of a mesh, and removal of small ones.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Returns a mesh of only the given triangles, whose vertex indices refer to `mesh`, and of the vertices they
/// use, in order of first use.
Mesh compacted(const Mesh& mesh, const std::vector<Triangle>& triangles);

/// Drops unused vertices, and connected components (by shared vertices) with an area below
/// min_component_area_m2.
Mesh drop_small_components(const Mesh& mesh, float min_component_area_m2);

}  // namespace roomradar
