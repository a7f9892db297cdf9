// gltf_model.hpp: the model of a glTF file: geometry, base colours and base-colour textures.
#pragma once
#include <filesystem>

#include "app/models/model.hpp"

namespace roomradar {

/// Reads a .gltf or .glb file in its own axes (y up). Call it within run_sandboxed(): decoders of meshes and
/// images are third-party code.
///
/// Draws what the base colour tells: factor, texture, vertex colours, their product in linear light. Alpha
/// cuts holes (MASK at the material's cutoff, BLEND at 0.5). Model::notes names what else the file contains:
/// other textures, metal, emitted light, half transparency, animations, points and lines, unknown extensions.
/// @throws Error naming the file if it is damaged or requires an unknown extension
Model read_gltf_model(const std::filesystem::path& path);

}  // namespace roomradar
