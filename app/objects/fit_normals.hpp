// fit_normals.hpp: fits a simplified mesh's normals so that its shading matches the fine mesh's.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Sets the coarse mesh's normals so that their interpolation over its triangles best matches the fine mesh's
/// normals: least squares over the fine surface. Each fine point is compared with the nearest coarse triangle
/// that faces the same way. Averaging merged normals, as a simplified mesh does, would look flatter. Vertices
/// that no fine point corresponds to keep their normals.
///
/// @param fine       with normals; normals that are not finite are ignored
/// @param reach_m    max distance (> 0) of the coarse surface from the fine one
/// @param spacing_m  (> 0) between sample points on large fine triangles; small triangles have one point each
/// @param coarse     with normals, of the same origin
void fit_normals(const Mesh& fine, float reach_m, float spacing_m, Mesh& coarse);

}  // namespace roomradar
