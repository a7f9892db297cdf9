// model_file.cpp: reads a model in a sandbox and rotates it to +z up; reads and writes model copies.
#include "app/models/model_file.hpp"

#include <assimp/config.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cstdint>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "app/models/gltf_model.hpp"
#include "app/models/scene_materials.hpp"
#include "app/models/texture_file.hpp"
#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/scene_mesh.hpp"
#include "mapping/mesh/serialize_mesh.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/run_sandboxed.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

constexpr std::array<const char*, 6> kExtensions = {".glb", ".gltf", ".obj", ".ply", ".stl", ".dae"};
constexpr std::string_view kCopyHead = "roomradar model 2\n";
constexpr std::string_view kCopyHead1 = "roomradar model 1\n";  ///< without Texture::is_pixelated
constexpr std::uintmax_t kMaxCopyBytes = std::uintmax_t{1} << 30U;

template <typename Archive, typename Pixel>
void serialize_image(Archive& archive, Image<Pixel>& image) {
  serialize(archive, image.width);
  serialize(archive, image.height);
  serialize_items(archive, image.pixels);
  if constexpr (Archive::kReads) {
    const bool is_whole =
        image.width >= 0 && image.height >= 0 && image.width <= kMaxTextureSide_px &&
        image.height <= kMaxTextureSide_px &&
        image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    if (!is_whole) archive.fail("is damaged: a texture has the wrong size");
  }
}

}  // namespace

template <typename Archive>
void serialize(Archive& archive, Texture& texture) {
  serialize_image(archive, texture.colour);
  serialize_image(archive, texture.opacity);
  serialize(archive, texture.least_opacity);
  serialize(archive, texture.wrap_u, TextureWrap::kClamp);
  serialize(archive, texture.wrap_v, TextureWrap::kClamp);
}

template <typename Archive>
void serialize(Archive& archive, Model& model, bool has_filters = true) {
  serialize(archive, model.mesh);
  serialize_items(archive, model.texture_points);
  serialize_items(archive, model.parts);
  serialize(archive, model.textures);
  if (!has_filters) return;
  for (Texture& texture : model.textures) serialize(archive, texture.is_pixelated);
}

namespace {

/// Throws Error if the parts of the model do not fit each other.
void require_consistent(const Model& model, const std::string& where) {
  const Mesh& mesh = model.mesh;
  const auto is_per_vertex = [&](std::size_t count) { return count == 0 || count == mesh.vertices.size(); };
  bool fits = is_per_vertex(mesh.normals.size()) && is_per_vertex(mesh.colours.size()) &&
              is_per_vertex(model.texture_points.size()) && mesh.origin.allFinite() &&
              model.is_textured() == !model.texture_points.empty() &&
              std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                          [&](const Triangle& t) { return is_usable(mesh, t); });
  std::uint64_t next = 0;
  for (const ModelPart& part : model.parts) {
    fits = fits && part.first_triangle == next && part.texture >= kNoTexture &&
           part.texture < static_cast<std::int64_t>(model.textures.size());
    next += part.triangle_count;
  }
  for (const Texture& texture : model.textures)
    fits = fits && !texture.colour.empty() &&
           (texture.opacity.empty() || (texture.opacity.width == texture.colour.width &&
                                        texture.opacity.height == texture.colour.height));
  if (!fits || (model.is_textured() && next != mesh.triangles.size()))
    throw Error(where + ": is damaged: its parts do not fit each other");
}

/// Returns the axis that a .dae states, y if it states none. Source: COLLADA 1.4.1 specification, <up_axis>.
UpAxis stated_up(const std::filesystem::path& dae) {
  std::ifstream file(dae, std::ios::binary);
  std::string start(1U << 20U, '\0');  // <asset> comes first
  file.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(file.gcount()));
  const std::size_t at = start.find("<up_axis>");
  const std::string word = at == std::string::npos ? "" : start.substr(at + 9, 16);
  if (word.find("Z_UP") != std::string::npos) return UpAxis::kZ;
  return word.find("X_UP") != std::string::npos ? UpAxis::kX : UpAxis::kY;
}

UpAxis usual_up(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  if (extension == ".dae") return stated_up(path);
  return extension == ".ply" || extension == ".stl" ? UpAxis::kZ : UpAxis::kY;
}

Model read_by_assimp(const std::filesystem::path& path) {
  Assimp::Importer importer;
  const aiScene& scene = import_scene(importer, path, 0);
  SceneMesh collected = scene_mesh(path, scene, {.mixes_normals = true});
  Model model;
  model.mesh = std::move(collected.mesh);
  if (model.mesh.triangles.empty())
    fail_for_file(path, "contains no triangles with an area; must be a surface mesh");
  set_appearance(path, scene, collected.parts, model);
  return model;
}

Model read_sandboxed(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  std::error_code ignored;
  if (extension.empty() && !std::filesystem::exists(path, ignored))
    fail_for_file(path, std::string("there is no such file; a model is a file ") + kModelFormats +
                            ", or the built-in teapot");
  if (std::find(kExtensions.begin(), kExtensions.end(), extension) == kExtensions.end())
    fail_for_file(path, extension.find('=') != std::string::npos
                            ? "\"" + extension +
                                  "\" is not a model file extension; `roomradar help models` lists what may "
                                  "follow a comma"
                            : "the extension \"" + extension + "\" is not a supported model format; use " +
                                  kModelFormats + ", or the built-in teapot");
  require_plausible_size(path);
  const std::uintmax_t bytes = std::filesystem::file_size(path);
  const auto most_s = static_cast<unsigned>(30 + (bytes >> 20U));  // for textures, too
  const std::size_t max_bytes = (std::size_t{2} << 30U) + 64 * bytes;
  const std::string answer = run_sandboxed(
      [&] {
        Model model =
            extension == ".glb" || extension == ".gltf" ? read_gltf_model(path) : read_by_assimp(path);
        ByteWriter writer;
        serialize(writer, model);
        serialize(writer, model.notes);
        return writer.bytes();
      },
      path.string() + ": cannot be read; is it damaged?", most_s, max_bytes);
  ByteReader reader(answer, path.string());
  Model model;
  serialize(reader, model);
  serialize(reader, model.notes);
  reader.require_end();
  return model;
}

/// Takes the middle of the bounding box as origin if the file's is farther away than the longest side.
void bring_origin_near(const std::filesystem::path& path, Model& model) {
  Eigen::AlignedBox3d box;
  for (const Triangle& t : model.mesh.triangles)
    for (const std::uint32_t vertex : t) box.extend(model.mesh.vertices[vertex].cast<double>());
  const double away_m = box.exteriorDistance(Eigen::Vector3d::Zero());
  if (!(away_m > box.sizes().maxCoeff())) return;
  const Eigen::Vector3d middle = box.center();
  for (Eigen::Vector3f& vertex : model.mesh.vertices) vertex = (vertex.cast<double>() - middle).cast<float>();
  model.notes.push_back(path.string() + ": lies " + format_readable(away_m, 3) +
                        " m from the origin of its file; its middle is taken as its origin");
}

Model read_copy(const std::filesystem::path& path) {
  const std::string bytes = read_bytes(path, "a model of a recorded session", kMaxCopyBytes);
  if (!bytes.starts_with(kCopyHead) && !bytes.starts_with(kCopyHead1))
    fail_for_file(path, "is not a model of a recorded session, or is damaged");
  ByteReader reader(std::string_view(bytes).substr(kCopyHead.size()), path.string());
  Model model;
  serialize(reader, model, bytes.starts_with(kCopyHead));
  reader.require_end();
  return model;
}

}  // namespace

Model read_model(const std::filesystem::path& path, std::optional<UpAxis> up, ModelOrigin origin) {
  const bool is_copy = lower_extension(path) == kModelCopyExtension;
  Model model = is_copy ? read_copy(path) : read_sandboxed(path);
  require_consistent(model, path.string());
  if (is_copy) return model;
  stand_up(model.mesh, up.value_or(usual_up(path)));
  if (origin == ModelOrigin::kNear) bring_origin_near(path, model);
  return model;
}

void write_model_copy(const Model& model, const std::filesystem::path& path) {
  Model copy = model;  // serialize() takes what it reads and what it writes alike
  ByteWriter writer;
  writer.raw(kCopyHead.data(), kCopyHead.size());
  serialize(writer, copy);
  write_bytes(path, writer.bytes());
}

}  // namespace roomradar
