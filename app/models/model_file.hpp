// model_file.hpp: reads models as their authors made them.
#pragma once
#include <filesystem>
#include <optional>

#include "app/models/model.hpp"
#include "app/models/up_axis.hpp"

namespace roomradar {

inline constexpr const char* kModelFormats = ".glb, .gltf, .obj, .ply, .stl or .dae";

enum class ModelOrigin {
  kNear,      ///< an origin far from the model is replaced by the model's middle
  kAsInFile,  ///< the file's
};

/// Reads a .glb, .gltf, .obj, .ply, .stl or .dae file in a sandbox: geometry, normals, vertex colours,
/// material colours and base-colour textures. Skinned meshes are read in their rest pose.
///
/// The result stands: +z is up. Coordinates are metres, as glTF prescribes and a .dae states; the other
/// formats state no unit, and their numbers are taken as metres. With ModelOrigin::kNear, a model that is
/// farther from its origin than its longest side gets its middle as origin, with a note. Textures that cannot
/// be read are named in Model::notes.
///
/// @param up  axis of the file that points up; unset: y for .glb, .gltf and .obj, z for .ply and .stl, and
///            what a .dae states
/// @throws Error naming the file, the fault and a remedy, as read_mesh() does
Model read_model(const std::filesystem::path& path, std::optional<UpAxis> up = std::nullopt,
                 ModelOrigin origin = ModelOrigin::kNear);

/// Extension of model copies.
inline constexpr const char* kModelCopyExtension = ".model";
/// Writes a model with its textures, for recorded sessions. read_model() restores it bit by bit, without its
/// notes; `up` and `origin` do not apply to such a file. Throws Error if writing fails.
void write_model_copy(const Model& model, const std::filesystem::path& path);

}  // namespace roomradar
