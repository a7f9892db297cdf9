// fit_normals.hpp: fits a simplified mesh's normals to the fine mesh's shading.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Sets the coarse mesh's normals by least squares over the fine surface: their interpolation over the coarse
/// triangles best matches the fine normals. Each sample point of the fine surface corresponds to the nearest
/// coarse triangle that faces the same way. The averages of merged normals that a simplified mesh has would
/// look flatter. Vertices of triangles without correspondence keep their normals.
///
/// @param fine       with normals; normals that are not finite are ignored
/// @param reach_m    max distance (> 0) of the coarse surface from the fine one
/// @param spacing_m  (> 0) between sample points on large fine triangles; small triangles have one point each
/// @param coarse     with normals; must have the origin of `fine`
void fit_normals(const Mesh& fine, float reach_m, float spacing_m, Mesh& coarse);

}  // namespace roomradar
