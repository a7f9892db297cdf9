// edge_collapse.hpp: greedy edge collapse of a mesh, cheapest edge first, within a distance bound.
#pragma once
#include <vector>

#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Collapses edges while every vertex of `full` stays within tolerance_m (one per vertex, m, >= 0) of the
/// triangles that replace its own. Vertices with tolerance 0 are constrained: they do not move, and no new
/// edge connects two of them. New vertices stay within the same tolerances of `full_surface`, the surface of
/// `full`. The result has all vertices of `full`, moved, and fewer triangles. Used by mesh_simplify.cpp only.
Mesh collapsed(const Mesh& full, const MeshDistanceQuery& full_surface,
               const std::vector<float>& tolerance_m);

}  // namespace roomradar
