// fit_normals.hpp: light a coarse mesh as the fine one that it stands for is lit.
#pragma once
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Gives the coarse mesh the normals that, interpolated over its triangles, come nearest to the fine mesh's:
/// the least sum of squares over the fine surface, each of whose points counts for the nearest triangle of
/// the coarse one that faces the same way. A mean over what was merged, as a simplified mesh has it, is
/// flatter than that. Normals that no point tells of stay.
///
/// @param fine       with normals; those that are not finite do not count
/// @param reach_m    the coarse surface lies no farther (> 0) from the fine one
/// @param spacing_m  (> 0) of the points on the fine one's large triangles; small ones have one point each
/// @param coarse     with normals, of the same origin
void fit_normals(const Mesh& fine, float reach_m, float spacing_m, Mesh& coarse);

}  // namespace roomradar
