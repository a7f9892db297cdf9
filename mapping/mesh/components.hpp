// mesh_pieces.hpp: the connected pieces of a mesh, and which of them are specks.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A mesh of these triangles of `mesh` (three indices each), with only the vertices that they use, in the
/// order of their use.
Mesh compacted(const Mesh& mesh, const std::vector<Triangle>& triangles);

/// Drops connected pieces (by shared vertices) with less area than given, and all vertices that no triangle
/// uses.
Mesh without_specks(const Mesh& mesh, float min_component_area_m2);

}  // namespace roomradar
