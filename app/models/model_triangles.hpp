// model_triangles.hpp: extracts triangles of a model as a new model.
#pragma once
#include <cstdint>
#include <span>

#include "app/models/model.hpp"

namespace roomradar {

/// Returns a model of the given triangles, in the given order, and the vertices that they use. Vertices have
/// positions, normals, colours and texture coordinates. The result has no parts and textures.
Model triangles_alone(const Model& model, std::span<const std::uint32_t> triangles);

}  // namespace roomradar
