// scene_materials.hpp: colours and textures of an assimp scene's materials.
#pragma once
#include <filesystem>
#include <span>

#include "app/models/model.hpp"
#include "mapping/mesh/scene_mesh.hpp"

struct aiScene;

namespace roomradar {

/// Sets the model's colours, texture coordinates, parts, textures and notes from the scene.
///
/// Colours are taken as sRGB, and vertex colours replace the material's colour. A texture then replaces both.
/// In an .obj, however, the diffuse colour multiplies the texture. A model without any colour gets none. For
/// a texture that is missing or broken, a note is added and the material's colour is used. Decodes image
/// files, so call this function within run_sandboxed().
///
/// @param parts  parts of model.mesh, from scene_mesh()
void set_appearance(const std::filesystem::path& path, const aiScene& scene, std::span<const ScenePart> parts,
                    Model& model);

}  // namespace roomradar
