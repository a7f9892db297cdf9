// model_file.hpp: reads model files with their units, axes, colours and textures.
#pragma once
#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>

#include "app/models/model.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class UpAxis { kX, kY, kZ, kMinusX, kMinusY, kMinusZ };

/// Names of the axes, by UpAxis.
inline constexpr std::array<std::string_view, 6> kUpAxisNames = {"x", "y", "z", "-x", "-y", "-z"};
inline constexpr std::string_view kUpAxisWords = "x, y, z, -x, -y or -z";

/// Returns one of the words "x", "y", "z", "-x", "-y" and "-z".
std::string_view to_string(UpAxis up);
/// Returns the axis of such a word, or nullopt for any other word.
std::optional<UpAxis> up_axis_of(std::string_view word);

/// Rotates the mesh so that axis `up` points to +z. Only exchanges and negates coordinates, so the result is
/// exact.
void stand_up(Mesh& mesh, UpAxis up);

inline constexpr const char* kModelFormats = ".glb, .gltf, .obj, .ply, .stl or .dae";

enum class ModelOrigin {
  kNear,      ///< an origin far from the model is replaced by the centre of the model's bounding box
  kAsInFile,  ///< the origin is that of the file
};

/// Reads a .glb, .gltf, .obj, .ply, .stl or .dae file in a sandbox. Reads geometry, normals, vertex colours,
/// material colours and base-colour textures. Skinned meshes are read in their rest pose. Reads no file
/// outside of the model's folder.
///
/// In the result, +z is up and coordinates are in metres. glTF prescribes metres, and a .dae file states its
/// unit. Numbers in the other formats are taken as metres. With ModelOrigin::kNear, an origin farther from
/// the model than its longest side is moved to the model's centre, and a note is added. Model::notes names
/// textures that cannot be read, and what of a glTF file is not drawn (read_gltf_model()).
///
/// @param up  axis of the file that points up; unset: y for .glb, .gltf and .obj, z for .ply and .stl, and
///            the axis that a .dae states (y if none)
/// @throws Error with the file's name, the fault and a remedy, as read_mesh() does
Model read_model(const std::filesystem::path& path, std::optional<UpAxis> up = std::nullopt,
                 ModelOrigin origin = ModelOrigin::kNear);

/// Extension of files with a model_copy().
inline constexpr const char* kModelCopyExtension = ".model";
/// Returns the content of a file with the model and its textures, for recorded sessions and kept objects.
/// read_model() restores the model exactly, without its notes, and ignores `up` and `origin` for such a file.
std::string model_copy(const Model& model);
/// Writes a model_copy(). Throws Error if the file cannot be written.
void write_model_copy(const Model& model, const std::filesystem::path& path);

}  // namespace roomradar
