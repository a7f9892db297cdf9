// mesh_simplify.hpp: mesh simplification within a guaranteed distance bound.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A simplified mesh and its measured distance from the original.
struct SimplifiedMesh {
  Mesh mesh;
  /// Two-sided (Hausdorff) distance between the surfaces, m, at most max_deviation_m. The distance is
  /// measured at all vertices and at points spacing_m apart. Between the points, the distance may be slightly
  /// larger.
  float deviation_m = 0.0F;
  /// Per vertex: index of a vertex of the original that was merged into it.
  std::vector<std::uint32_t> full_vertex{};
};

inline constexpr std::size_t kBlockTriangles = 6000;  ///< a block of this size fits the CPU cache

/// Collapses edges in order of quadric error, and moves each new vertex to the least-squares intersection of
/// the planes around it. Flat areas become few large triangles. Curved areas keep small ones.
///
/// Bound: during collapses, every original vertex stays within 0.6 max_deviation_m (> 0) of the triangles
/// that replace those around it. Afterwards the distance between both surfaces is measured at points
/// spacing_m apart. Where the distance exceeds max_deviation_m, the tolerances of nearby vertices are lowered
/// and the block is simplified again. A block that still exceeds the bound after the last attempt is left
/// unchanged.
///
/// A mesh of more than block_triangles (>= 1) triangles is split into blocks of at most block_triangles,
/// which all hardware threads process. Vertices on seams between blocks are constrained, so no cracks appear.
/// Small blocks fit the cache, and repeating one block is cheap. Large blocks have fewer constrained
/// vertices. Components, holes and handles are preserved, and an edge shared by two triangles stays shared by
/// two. Colours and normals are averaged over merged vertices. Collapses that would create triangles less
/// than 0.1 mm high are rejected. Source: Garland and Heckbert, Surface Simplification Using Quadric Error
/// Metrics, SIGGRAPH 1997; bound: Klein, Liebich, Strasser, Mesh reduction with error control, IEEE
/// Visualization 1996.
/// @param fixed  per vertex: true if it must stay unchanged; empty: none
SimplifiedMesh simplified(Mesh mesh, float max_deviation_m, float spacing_m,
                          std::size_t block_triangles = kBlockTriangles, std::vector<bool> fixed = {});

}  // namespace roomradar
