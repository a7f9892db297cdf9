// dual_marching_cubes.hpp: extracts the zero level set of signed distances at voxel resolution.
#pragma once
#include "mapping/surface/tsdf_levels.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Extracts the surface by dual marching cubes. A cell is a cube whose eight corners are neighbouring
/// samples. Each cell gets one vertex per surface sheet, at the weighted mean of the sheet's zero crossings
/// on the cell's edges. Each crossed edge between measured samples whose four cells have vertices gets a quad
/// (two triangles). A cell with an unknown corner has no vertex, so unobserved areas stay open. Extrapolated
/// samples count as known corners: a crossing next to one has little weight in a vertex, and gets no quad.
/// Vertices are in the world (mesh.origin + vertex), at multiples of 2^-17 m (8 um). Triangles and normals
/// (gradient of the trilinear distance) face the free side. Colours come from the samples, or are grey if the
/// samples have none.
///
/// Within one grid, edges of the mesh are manifold. Each has two triangles, or one at the mesh's border,
/// where measured samples end. On each face of a cell, the crossings of its edges are connected in pairs;
/// connected crossings form a sheet. An ambiguous face (equal signs on each diagonal) separates its two
/// inside corners. If all four crossings of an ambiguous face then belong to one sheet in both adjacent
/// cells, the face separates its outside corners instead. Source: Gibson, Constrained Elastic Surface Nets,
/// MICCAI 1998 (placement); Nielson, Dual Marching Cubes, IEEE Visualization 2004 (sheets); Wenger,
/// Isosurfaces, CRC Press 2013, chapter 3 (manifold faces).
///
/// Where the fine and the coarse grid of a map meet, a cell consists of the eight samples around a corner of
/// a voxel. Several of the eight may be the same coarse sample. A polygon around a crossing between two
/// coarse samples has up to eight corners, one per adjacent cell of either grid. Hence there are no cracks.
/// At an ambiguous face between a fine and a coarse cell, the two cells may choose different sheets, so edges
/// there may not be manifold. Source: Schaefer and Warren, Dual Marching Cubes: Primal Contouring of Dual
/// Grids, Pacific Graphics 2004 (cells of a dual grid).
Mesh dual_marching_cubes(const TsdfLevels& levels, double resolution_m);

}  // namespace roomradar
