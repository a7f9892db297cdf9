// edge_collapse.hpp: greedy edge collapse of a mesh, cheapest edge first, within a distance bound.
#pragma once
#include <vector>

#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Collapses edges while every vertex of `full` stays within its tolerance_m of the new triangles that
/// replace its adjacent triangles. tolerance_m has one value per vertex, in m, >= 0. Vertices with tolerance
/// 0 are constrained: they do not move, and no new edge connects two constrained vertices. A new vertex's
/// distance from `full_surface`, the surface of `full`, is at most the larger tolerance of the two vertices
/// it replaces. Vertices keep their indices. Vertices that were merged into others remain in the list,
/// unreferenced. Used by mesh_simplify.cpp only.
Mesh collapsed(const Mesh& full, const MeshDistanceQuery& full_surface,
               const std::vector<float>& tolerance_m);

}  // namespace roomradar
