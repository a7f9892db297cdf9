// scene_materials.hpp: colours and textures of an assimp scene's materials.
#pragma once
#include <filesystem>
#include <span>

#include "app/models/model.hpp"
#include "mapping/mesh/scene_mesh.hpp"

struct aiScene;

namespace roomradar {

/// Sets the model's colours, texture points, parts, textures and notes from the scene.
///
/// Colours are in sRGB. glTF's factors and vertex colours are linear and multiply each other; in the other
/// formats colours are taken as sRGB, vertex colours replace the material's colour, and a texture replaces
/// both, except that an .obj's diffuse colour multiplies its texture. A model without any colour keeps none.
/// A texture that is missing or broken is named in a note, and the material's colour is used. Decodes
/// pictures: call this within run_sandboxed().
///
/// @param parts  of model.mesh, from scene_mesh()
void set_appearance(const std::filesystem::path& path, const aiScene& scene, std::span<const ScenePart> parts,
                    Model& model);

}  // namespace roomradar
