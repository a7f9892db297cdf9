// textured_lod.hpp: levels of detail of textured models.
#pragma once
#include <vector>

#include "app/models/model.hpp"
#include "app/objects/object_lod.hpp"

namespace roomradar {

/// Computes the levels of a model, as levels_of_detail() does for a mesh, with texture points, colours and
/// parts carried over. Vertices at texture seams stay apart, and each side of a seam keeps its own texture
/// points. deviation_m of a level also bounds the distance by which the texture is shifted along the surface,
/// for 95 % of the area, measured at the middles of triangles and edges.
std::vector<LevelOfDetail> levels_of_detail(const Model& model);

}  // namespace roomradar
