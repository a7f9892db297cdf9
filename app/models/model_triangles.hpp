// model_triangles.hpp: extracts some of a model's triangles as a new model.
#pragma once
#include <cstdint>
#include <span>

#include "app/models/model.hpp"

namespace roomradar {

/// Returns a model of the given triangles, in the given order, with the vertices that they use and all
/// attributes of these vertices. The result has neither parts nor textures nor notes.
/// @param triangles  indices into model.mesh.triangles
Model triangles_alone(const Model& model, std::span<const std::uint32_t> triangles);

}  // namespace roomradar
