// model_file.cpp: reads a model in a sandbox and rotates it to +z up; reads and writes model copies.
#include "app/models/model_file.hpp"

#include <assimp/config.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>

#include "app/models/gltf_model.hpp"
#include "app/models/model.hpp"
#include "app/models/texture_file.hpp"
#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/mesh_file.hpp"
#include "mapping/mesh/model_folder.hpp"
#include "mapping/mesh/scene_mesh.hpp"
#include "mapping/types/serialize.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/run_sandboxed.hpp"
#include "mapping/types/validity.hpp"

struct aiScene;

namespace roomradar {
namespace {

/// Texture of a material, as the file names it.
struct TextureName {
  std::string name;
  unsigned channel = 0;  ///< set of texture coordinates
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
};

/// Look of a material.
struct Look {
  aiColor3D colour{1.0F, 1.0F, 1.0F};  ///< sRGB
  bool is_stated = false;              ///< false: filled in by assimp
  std::int32_t texture = kNoTexture;
  unsigned channel = 0;
};

TextureWrap wrap_of(aiTextureMapMode mode) {
  if (mode == aiTextureMapMode_Mirror) return TextureWrap::kMirror;
  return mode == aiTextureMapMode_Wrap ? TextureWrap::kRepeat : TextureWrap::kClamp;
}

std::optional<TextureName> texture_name(const aiMaterial& material) {
  for (const aiTextureType type : {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR}) {
    aiString name;
    unsigned channel = 0;
    std::array<aiTextureMapMode, 3> modes{aiTextureMapMode_Wrap, aiTextureMapMode_Wrap,
                                          aiTextureMapMode_Wrap};
    if (material.GetTexture(type, 0, &name, nullptr, &channel, nullptr, nullptr, modes.data()) !=
            aiReturn_SUCCESS ||
        name.length == 0)
      continue;
    return TextureName{name.C_Str(), channel, wrap_of(modes[0]), wrap_of(modes[1])};
  }
  return std::nullopt;
}

/// Returns the material libraries that an .obj names and that cannot be read, each with the reason.
std::vector<std::pair<std::string, std::string>> unreadable_libraries(const std::filesystem::path& path) {
  constexpr int kLines = 10'000;  // they are named at the start
  std::vector<std::pair<std::string, std::string>> unreadable;
  if (lower_extension(path) != ".obj") return unreadable;
  std::ifstream file(path);
  std::string line;
  for (int i = 0; i < kLines && std::getline(file, line); ++i) {
    if (!line.starts_with("mtllib ")) continue;
    const std::size_t end = line.find_last_not_of(" \t\r");
    const std::string name = line.substr(7, end == std::string::npos ? 0 : end - 6);
    if (NamedFile found = file_in_folder_of(path, name); !found.fault.empty())
      unreadable.emplace_back(name, std::move(found.fault));
  }
  return unreadable;
}

class Appearance {
 public:
  Appearance(const std::filesystem::path& path, const aiScene& scene, Model& model)
      : path_(path), scene_(scene), model_(model), is_collada_(lower_extension(path) == ".dae") {
    for (const auto& [library, fault] : unreadable_libraries(path)) {
      note("its material file " + library + " " + fault + "; it is drawn without its materials");
      lacks_library_ = true;
    }
    std::set<std::string> names;
    for (unsigned i = 0; i < scene.mNumMaterials; ++i)
      if (const auto texture = texture_name(*scene.mMaterials[i])) names.insert(texture->name);
    max_pixels_ = kMaxTexturePixels / std::max<std::size_t>(names.size(), 1);
    for (unsigned i = 0; i < scene.mNumMaterials; ++i) looks_.push_back(look_of(i));
  }

  void apply(std::span<const ScenePart> parts) {
    bool has_colours = false;
    for (const ScenePart& part : parts) {
      const aiMesh& source = *scene_.mMeshes[part.source];
      const Look& look = look_at(source);
      has_colours = has_colours || look.is_stated || source.HasVertexColors(0);
    }
    model_.mesh.colours.clear();
    for (const ScenePart& part : parts) {
      if (has_colours) add_colours(part);
      add_texture_points(part);
    }
    if (model_.textures.empty()) {
      model_.texture_points.clear();
      model_.parts.clear();
    }
  }

 private:
  const std::filesystem::path& path_;
  const aiScene& scene_;
  Model& model_;
  bool is_collada_;
  bool lacks_library_ = false;
  std::size_t max_pixels_ = 0;
  std::vector<Look> looks_;
  std::map<std::tuple<std::string, TextureWrap, TextureWrap>, std::int32_t> textures_;

  void note(const std::string& sentence) { model_.notes.push_back(path_.string() + ": " + sentence); }

  const Look& look_at(const aiMesh& part) const {
    static const Look kNone;
    return part.mMaterialIndex < looks_.size() ? looks_[part.mMaterialIndex] : kNone;
  }

  /// Returns true if the file states the material, and assimp did not fill it in.
  [[nodiscard]] bool is_stated(const aiMaterial& material, const aiColor3D& colour) const {
    aiString name;
    material.Get(AI_MATKEY_NAME, name);
    const bool is_usual = colour == aiColor3D(0.6F, 0.6F, 0.6F) || colour == aiColor3D(1.0F, 1.0F, 1.0F);
    return !is_usual || !(lacks_library_ || std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME);
  }

  Look look_of(unsigned index) {
    const aiMaterial& material = *scene_.mMaterials[index];
    Look look;
    if (material.Get(AI_MATKEY_COLOR_DIFFUSE, look.colour) != aiReturn_SUCCESS)
      material.Get(AI_MATKEY_BASE_COLOR, look.colour);
    look.is_stated = is_stated(material, look.colour);
    const std::optional<TextureName> name = texture_name(material);
    if (!name) return look;
    look.is_stated = true;
    look.texture = texture_of(*name);
    look.channel = name->channel;
    if (look.texture == kNoTexture) return look;
    // Many exporters write black, or any colour, for a material whose texture gives the colour.
    if (is_collada_ || look.colour.IsBlack()) look.colour = aiColor3D(1.0F, 1.0F, 1.0F);
    return look;
  }

  /// Returns the index of the texture; kNoTexture, with a note, if it cannot be read.
  std::int32_t texture_of(const TextureName& name) {
    const auto [known, is_new] = textures_.try_emplace({name.name, name.wrap_u, name.wrap_v}, kNoTexture);
    if (!is_new) return known->second;
    try {
      Texture texture = read(name.name);
      texture.wrap_u = name.wrap_u;
      texture.wrap_v = name.wrap_v;
      known->second = static_cast<std::int32_t>(model_.textures.size());
      model_.textures.push_back(std::move(texture));
    } catch (const Error& fault) {
      const bool is_embedded = scene_.GetEmbeddedTexture(name.name.c_str()) != nullptr;
      note("its " + std::string(is_embedded ? "embedded " : "") + "texture " + name.name + " " +
           fault.what() + "; the material's colour is drawn instead");
    }
    return known->second;
  }

  Texture read(const std::string& name) {
    if (const aiTexture* embedded = scene_.GetEmbeddedTexture(name.c_str())) {
      const auto* bytes = reinterpret_cast<const char*>(embedded->pcData);
      if (embedded->mHeight == 0) return decode_texture({bytes, embedded->mWidth}, max_pixels_);
      return texture_of_bgra({bytes, std::size_t{4} * embedded->mWidth * embedded->mHeight},
                             static_cast<int>(embedded->mWidth), static_cast<int>(embedded->mHeight),
                             max_pixels_);
    }
    const NamedFile found = find_texture(path_, name);
    if (!found.fault.empty()) throw Error(found.fault);
    return read_texture(found.path, max_pixels_);
  }

  void add_colours(const ScenePart& part) {
    const aiMesh& source = *scene_.mMeshes[part.source];
    const Look& look = look_at(source);
    const bool uses_vertices = source.HasVertexColors(0) && look.texture == kNoTexture;
    for (std::uint32_t i = 0; i < part.vertex_count; ++i) {
      aiColor3D colour = look.colour;
      if (uses_vertices) {
        const aiColor4D& own = source.mColors[0][i];
        colour = aiColor3D(own.r, own.g, own.b);
      }
      model_.mesh.colours.push_back({channel_of(colour.r), channel_of(colour.g), channel_of(colour.b)});
    }
  }

  void add_texture_points(const ScenePart& part) {
    const aiMesh& source = *scene_.mMeshes[part.source];
    const Look& look = look_at(source);
    const unsigned channel = source.HasTextureCoords(look.channel) ? look.channel : 0;
    const bool is_textured = look.texture != kNoTexture && source.HasTextureCoords(channel);
    if (look.texture != kNoTexture && !is_textured)
      note("a part with a texture has no texture coordinates; the material's colour is drawn instead");
    for (std::uint32_t i = 0; i < part.vertex_count; ++i) {
      Eigen::Vector2f point = Eigen::Vector2f::Zero();
      if (is_textured) {
        const aiVector3D& uv = source.mTextureCoords[channel][i];  // v runs up
        if (std::isfinite(uv.x) && std::isfinite(uv.y)) point = {uv.x, 1.0F - uv.y};
      }
      model_.texture_points.push_back(point);
    }
    const std::int32_t texture = is_textured ? look.texture : kNoTexture;
    if (!model_.parts.empty() && model_.parts.back().texture == texture)
      model_.parts.back().triangle_count += part.triangle_count;
    else
      model_.parts.push_back({part.first_triangle, part.triangle_count, texture});
  }
};

/// Sets the model's colours, texture coordinates, parts, textures and notes from the scene.
///
/// Colours are taken as sRGB, and vertex colours replace the material's colour. A texture then replaces both.
/// In an .obj, however, the diffuse colour multiplies the texture. A model without any colour gets none. For
/// a texture that is missing or broken, a note is added and the material's colour is used. Decodes image
/// files, so call this function within run_sandboxed().
///
/// @param parts  parts of model.mesh, from scene_mesh()
void set_appearance(const std::filesystem::path& path, const aiScene& scene, std::span<const ScenePart> parts,
                    Model& model) {
  Appearance(path, scene, model).apply(parts);
}

/// Returns the vector after the rotation that takes the axis to +z.
template <typename Vector>
Vector turned(const Vector& p, UpAxis up) {
  switch (up) {
    case UpAxis::kX:
      return {-p.z(), p.y(), p.x()};
    case UpAxis::kY:
      return {p.x(), -p.z(), p.y()};
    case UpAxis::kMinusX:
      return {p.z(), p.y(), -p.x()};
    case UpAxis::kMinusY:
      return {p.x(), p.z(), -p.y()};
    case UpAxis::kMinusZ:
      return {p.x(), -p.y(), -p.z()};
    case UpAxis::kZ:
      break;
  }
  return p;
}

}  // namespace

std::string_view to_string(UpAxis up) { return kUpAxisNames[static_cast<std::size_t>(up)]; }

std::optional<UpAxis> up_axis_of(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  for (std::size_t i = 0; i < kUpAxisNames.size(); ++i)
    if (word == kUpAxisNames[i]) return static_cast<UpAxis>(i);
  return std::nullopt;
}

void stand_up(Mesh& mesh, UpAxis up) {
  if (up == UpAxis::kZ) return;
  mesh.origin = turned(mesh.origin, up);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex = turned(vertex, up);
  for (Eigen::Vector3f& normal : mesh.normals) normal = turned(normal, up);
}

namespace {

constexpr std::array<const char*, 6> kExtensions = {".glb", ".gltf", ".obj", ".ply", ".stl", ".dae"};
constexpr std::string_view kCopyHead = "roomradar model 2\n";
constexpr std::string_view kCopyHead1 = "roomradar model 1\n";  ///< without Texture::is_pixelated
constexpr std::uintmax_t kMaxCopyBytes = std::uintmax_t{1} << 30U;

template <typename Archive, typename Picture>
void serialize_image(Archive& archive, Picture& image) {
  archive(image.width, image.height);
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
void serialize(Archive& archive, Ref<Archive, Texture> texture) {
  serialize_image(archive, texture.colour);
  serialize_image(archive, texture.opacity);
  archive(texture.least_opacity);
  serialize(archive, texture.wrap_u, TextureWrap::kClamp);
  serialize(archive, texture.wrap_v, TextureWrap::kClamp);
}

template <typename Archive>
void serialize(Archive& archive, Ref<Archive, Model> model, bool has_filters = true) {
  archive(model.mesh);
  serialize_items(archive, model.texture_points);
  serialize_items(archive, model.parts);
  archive(model.textures);
  if (!has_filters) return;
  for (auto& texture : model.textures) archive(texture.is_pixelated);
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
        writer(model, model.notes);
        return std::move(writer.bytes);
      },
      path.string() + ": cannot be read; is it damaged?", most_s, max_bytes);
  ByteReader reader(answer, path.string());
  Model model;
  reader(model, model.notes);
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

std::string model_copy(const Model& model) {
  ByteWriter writer;
  writer.raw(kCopyHead.data(), kCopyHead.size());
  writer(model);
  return std::move(writer.bytes);
}

void write_model_copy(const Model& model, const std::filesystem::path& path) {
  write_bytes(path, model_copy(model));
}

}  // namespace roomradar
