// mesh_simplify.hpp: fewer triangles for the same surface, within a bound that is kept.
#pragma once
#include <cstddef>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A mesh with fewer triangles, and how far it lies from the one it was made from.
struct SimplifiedMesh {
  Mesh mesh;
  /// Greatest distance from either surface to the other that was measured (m), on points spacing_m apart on
  /// both, all vertices included. Not above the bound; between those points it may be a little more.
  float deviation_m = 0.0F;
};

inline constexpr std::size_t kBlockTriangles = 6000;  ///< fit the cache

/// Collapses edges, cheapest first by their quadric error, to where the planes round them meet best: flat
/// parts become few large triangles, bent ones keep small ones. Every vertex of `mesh` stays within
/// max_deviation_m (> 0) of the triangles that take its place, collapse by collapse. Then both surfaces are
/// measured against each other; where they lie farther apart than the bound, `mesh` is kept as it is and the
/// rest done again. A mesh with more triangles than block_triangles (>= 1) is done in blocks of so many, by
/// two threads; vertices on the seams between blocks stay, so that nothing tears: small blocks fit the cache
/// and are done again alone, large ones have less seam. The surface's pieces, holes and handles stay, and
/// edges with two triangles keep two. Colours and normals are means over what was merged. Triangles flatter
/// than 0.01 mm are not made. Source: Garland and Heckbert, Surface Simplification Using Quadric Error
/// Metrics, SIGGRAPH 1997; Klein, Liebich, Strasser, Mesh reduction with error control, IEEE Visualization
/// 1996 (the bound).
SimplifiedMesh simplified(Mesh mesh, float max_deviation_m, float spacing_m,
                          std::size_t block_triangles = kBlockTriangles);

}  // namespace roomradar
