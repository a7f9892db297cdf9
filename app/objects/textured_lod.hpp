// textured_lod.hpp: levels of detail of textured models.
#pragma once
#include <vector>

#include "app/models/model.hpp"
#include "app/objects/object_lod.hpp"

namespace roomradar {

/// Computes the levels of detail of a model as levels_of_detail(const Mesh&) does, and transfers texture
/// coordinates, colours and parts to them. Coincident vertices along texture seams are not merged, and each
/// side of a seam keeps its own texture coordinates. On 95 % of a level's area, the texture is shifted along
/// the surface by at most deviation_m. The shift is measured at the centres of triangles and edges.
std::vector<LevelOfDetail> levels_of_detail(const Model& model);

}  // namespace roomradar
