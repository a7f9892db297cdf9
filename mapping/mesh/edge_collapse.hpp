// edge_collapse.hpp: collapsing a mesh's edges one after the other, cheapest first, within a bound.
#pragma once
#include <vector>

#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// The mesh after all collapses that keep every vertex of `full` within its own tolerance (one each, m, >= 0)
/// of the triangles that took the place of its own. Vertices without tolerance stay where they are, and no
/// two of them get a new edge; new vertices are as near to `full_surface`, which is that of `full`. The
/// result has all vertices of `full`, moved, and fewer triangles. Private to the simplification, which says
/// more.
Mesh collapsed(const Mesh& full, const SurfaceNear& full_surface, const std::vector<float>& tolerance_m);

}  // namespace roomradar
