// fit_normals.hpp: fits vertex normals of a simplified mesh to the normals of the full mesh.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Sets the vertex normals of the coarse mesh by linear least squares. The residuals are the differences
/// between fine normals, at sample points of the fine surface, and normals interpolated on the coarse
/// triangles. The correspondence of a sample point is the nearest coarse triangle that faces the same side.
/// Averages of merged vertex normals would shade the simplified mesh too flat. Vertices without
/// correspondences in their triangles keep their normals.
///
/// @param fine       with normals; normals that are not finite are ignored
/// @param reach_m    max distance (> 0) of a sample point from its corresponding triangle
/// @param spacing_m  max distance (> 0) between sample points on a fine triangle. A triangle whose longest
///                   side is at most spacing_m has one. A side is divided into at most 64 parts
/// @param coarse     with normals; Mesh::origin must equal that of `fine`
void fit_normals(const Mesh& fine, float reach_m, float spacing_m, Mesh& coarse);

}  // namespace roomradar
