// scene_materials.cpp: determines each material's colour and texture, then sets colours and texture
// coordinates per vertex.
#include "app/models/scene_materials.hpp"

#include <assimp/material.h>
#include <assimp/scene.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>

#include "app/models/texture_file.hpp"
#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/model_folder.hpp"
#include "mapping/types/system/error.hpp"

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

}  // namespace

void set_appearance(const std::filesystem::path& path, const aiScene& scene, std::span<const ScenePart> parts,
                    Model& model) {
  Appearance(path, scene, model).apply(parts);
}

}  // namespace roomradar
