// model_triangles.hpp: some triangles of a model as a model of their own.
#pragma once
#include <cstdint>
#include <span>

#include "app/models/model.hpp"

namespace roomradar {

/// Returns these triangles, in this order, with the vertices that they use: positions, normals, colours and
/// texture points. Without parts and textures.
Model triangles_alone(const Model& model, std::span<const std::uint32_t> triangles);

}  // namespace roomradar
