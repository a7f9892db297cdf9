// gltf_model.cpp: materials and textures of glTF. Source: glTF 2.0 specification, 3.8 to 3.9, and the
// extensions named below.
#include "app/models/gltf_model.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "app/models/texture_file.hpp"
#include "mapping/mesh/assimp_import.hpp"
#include "mapping/mesh/gltf_scene.hpp"
#include "mapping/mesh/scene_mesh.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

enum class AlphaMode { kOpaque, kMask, kBlend };

/// A texture as a material uses it.
struct TextureUse {
  std::size_t texture = 0;
  std::size_t set = 0;  ///< n of TEXCOORD_n
  Eigen::Affine2f image_from_set = Eigen::Affine2f::Identity();
};

/// What the base colour of a material is made of.
struct BaseColour {
  Eigen::Vector4f factor = Eigen::Vector4f::Ones();  ///< linear, with alpha
  std::optional<TextureUse> texture{};
  AlphaMode alpha = AlphaMode::kOpaque;
  float cutoff = 0.5F;

  /// False: no pixel reaches the alpha at which it is drawn.
  [[nodiscard]] bool is_visible() const {
    if (alpha == AlphaMode::kOpaque) return true;
    return alpha == AlphaMode::kMask ? factor.w() >= cutoff : factor.w() > 0.0F;
  }
  /// Returns the alpha of a texture's pixel from which on the pixel is drawn; 0: alpha is ignored.
  [[nodiscard]] std::uint8_t least_opacity() const {
    if (alpha == AlphaMode::kOpaque) return 0;
    return channel_of(alpha == AlphaMode::kMask ? cutoff / factor.w() : 0.5F);
  }
};

/// Reads KHR_texture_transform: scale, then rotation, then offset. The rotation is counter-clockwise for an
/// image whose rows run down, as the extension's text, its example and its test model have it; the matrix in
/// its text turns the other way. Source: Khronos' glTF issue 1563.
Eigen::Affine2f image_from_set(const GltfObject& transform) {
  const auto pair = [&](const char* key, double fallback) {
    const std::vector<double> two =
        transform.has(key) ? transform.numbers(key, 2) : std::vector<double>{fallback, fallback};
    return Eigen::Vector2d(two[0], two[1]);
  };
  Eigen::Affine2d T = Eigen::Affine2d::Identity();
  T.translate(pair("offset", 0.0)).rotate(-transform.number("rotation", 0.0)).scale(pair("scale", 1.0));
  return T.cast<float>();
}

TextureUse texture_use(const GltfObject& info) {
  TextureUse use{info.whole("index"), info.whole("texCoord", 0)};
  if (const auto transform = info.extension("KHR_texture_transform")) {
    use.set = transform->whole("texCoord", use.set);
    use.image_from_set = image_from_set(*transform);
  }
  return use;
}

BaseColour base_colour_of(const GltfObject& material) {
  BaseColour base;
  const std::string mode = material.text("alphaMode", "OPAQUE");
  base.alpha = mode == "MASK" ? AlphaMode::kMask : mode == "BLEND" ? AlphaMode::kBlend : AlphaMode::kOpaque;
  base.cutoff = static_cast<float>(material.number("alphaCutoff", 0.5));
  const auto specular = material.extension("KHR_materials_pbrSpecularGlossiness");
  const auto pbr = specular ? specular : material.object("pbrMetallicRoughness");
  if (!pbr) return base;
  const char* const factor = specular ? "diffuseFactor" : "baseColorFactor";
  if (pbr->has(factor)) {
    const std::vector<double> f = pbr->numbers(factor, 4);
    base.factor = Eigen::Vector4d(f[0], f[1], f[2], f[3]).cast<float>();
  }
  if (const auto info = pbr->object(specular ? "diffuseTexture" : "baseColorTexture"))
    base.texture = texture_use(*info);
  return base;
}

/// Names what a material has besides its base colour.
void name_the_rest(const GltfObject& material, NotDrawn& not_drawn) {
  const auto name = [&](const std::string& fate) { not_drawn.add("material", fate); };
  if (material.has("normalTexture")) name("drawn without normal texture");
  if (material.has("occlusionTexture")) name("drawn without occlusion texture");
  const std::vector<double> emitted = material.numbers("emissiveFactor");
  if (std::any_of(emitted.begin(), emitted.end(), [](double channel) { return channel > 0.0; }))
    name("drawn without the light that it emits");
  const auto metal = material.object("pbrMetallicRoughness");
  if (metal && metal->has("metallicRoughnessTexture"))
    name("drawn without metallic-roughness texture");
  else if (metal && metal->number("metallicFactor", 0.0) > 0.0)
    name("drawn as if painted, not as metal");
  const auto extensions = material.object("extensions");
  if (!extensions) return;
  for (const std::string& extension : extensions->keys()) {
    if (extension == "KHR_materials_unlit")
      name("unlit in the file, and drawn in the light of the room");
    else if (extension == "KHR_materials_pbrSpecularGlossiness")
      name("drawn by the diffuse colour alone, without specular colour and gloss");
    else if (extension.starts_with("KHR_materials_") && is_known_gltf_extension(extension))
      name("drawn without " + extension);
  }
}

TextureWrap wrap_of(const GltfObject& sampler, const char* key) {
  constexpr std::uint64_t kClamp = 33071, kMirror = 33648, kRepeat = 10497;
  const std::uint64_t mode = sampler.whole(key, kRepeat);
  if (mode == kMirror) return TextureWrap::kMirror;
  return mode == kClamp ? TextureWrap::kClamp : TextureWrap::kRepeat;
}

/// Returns the image of a texture: of the formats that an extension adds, WebP is decoded. Nullopt if there
/// is none that can be decoded.
std::optional<std::size_t> image_of(const GltfObject& texture) {
  if (const auto webp = texture.extension("EXT_texture_webp")) return webp->index("source");
  return texture.index("source");
}

class Builder {
 public:
  explicit Builder(const std::filesystem::path& path) : path_(path), document_(path) {}

  Model build() {
    for (std::size_t i = 0; i < document_.count("materials"); ++i)
      colours_.push_back(base_colour_of(document_.element("materials", i)));
    GltfScene scene = gltf_scene(
        document_, [&](const std::optional<std::size_t>& material) { return use_of(material); }, not_drawn_);
    model_.mesh = std::move(scene.mesh);
    if (model_.mesh.triangles.empty()) fail_without_triangles();
    for (const GltfPart& part : scene.parts)
      if (part.material) used_.insert(*part.material);
    read_textures();
    add_colours(scene);
    add_texture_points(scene);
    name_the_rest_of_the_file();
    return std::move(model_);
  }

 private:
  const std::filesystem::path& path_;
  GltfDocument document_;
  NotDrawn not_drawn_;
  Model model_;
  std::vector<BaseColour> colours_;                      // by material
  std::set<std::size_t> used_;                           // materials
  std::map<std::size_t, std::int32_t> texture_indices_;  // in model_.textures, by material

  void note(std::string sentence) {
    std::replace_if(  // names in the file may hold what a terminal obeys
        sentence.begin(), sentence.end(), [](unsigned char c) { return c < 32 || c == 127; }, '?');
    model_.notes.push_back(path_.string() + ": " + sentence);
  }

  [[noreturn]] void fail_without_triangles() const {
    std::string fault = "contains no triangles with an area; must be a surface mesh";
    for (const std::string& sentence : not_drawn_.sentences()) fault += "; " + sentence;
    document_.fail(fault);
  }

  GltfMaterialUse use_of(const std::optional<std::size_t>& material) {
    if (!material) return {};
    const GltfObject checked = document_.element("materials", *material);  // fails if it is not there
    const BaseColour& base = colours_[*material];
    GltfMaterialUse use{base.is_visible(), {}};
    if (base.texture) use.texture_set = base.texture->set;
    return use;
  }

  void read_textures() {
    std::set<std::size_t> images;
    for (const std::size_t material : used_)
      if (const auto& texture = colours_[material].texture)
        if (const auto image = image_of(document_.element("textures", texture->texture)))
          images.insert(*image);
    const std::size_t max_pixels = kMaxTexturePixels / std::max<std::size_t>(images.size(), 1);
    std::map<std::tuple<std::size_t, std::uint8_t>, std::int32_t> known;  // by texture and least opacity
    for (const std::size_t material : used_) {
      const BaseColour& base = colours_[material];
      if (!base.texture) continue;
      const auto [texture, is_new] =
          known.try_emplace({base.texture->texture, base.least_opacity()}, kNoTexture);
      if (is_new) texture->second = read_texture_of(base, max_pixels);
      texture_indices_[material] = texture->second;
    }
  }

  /// Returns the index of the texture that is added; kNoTexture, with a note, if it cannot be read.
  std::int32_t read_texture_of(const BaseColour& base, std::size_t max_pixels) {
    const GltfObject of = document_.element("textures", base.texture->texture);
    const std::optional<std::size_t> index = image_of(of);
    if (!index) {
      std::string format = "without a known image format";
      if (const auto extensions = of.object("extensions"))
        for (const std::string& name : extensions->keys())
          if (is_known_gltf_extension(name)) format = "in the format of " + name;
      not_drawn_.add("texture", format + " and not drawn; the material's colour is drawn instead");
      return kNoTexture;
    }
    const GltfObject image = document_.element("images", *index);
    try {
      Texture texture = decode_texture(document_.image(*index), max_pixels);
      if (const auto sampler = of.index("sampler")) {
        const GltfObject settings = document_.element("samplers", *sampler);
        constexpr std::uint64_t kNearest = 9728;
        texture.wrap_u = wrap_of(settings, "wrapS");
        texture.wrap_v = wrap_of(settings, "wrapT");
        texture.is_pixelated = settings.whole("magFilter", 0) == kNearest;
      }
      texture.least_opacity = base.least_opacity();
      if (texture.least_opacity == 0) texture.opacity = {};
      model_.textures.push_back(std::move(texture));
      return static_cast<std::int32_t>(model_.textures.size()) - 1;
    } catch (const Error& fault) {
      const std::string uri = image.text("uri");
      const bool is_embedded = uri.empty() || uri.starts_with("data:");
      std::string_view reason = fault.what();
      const std::string prefix = path_.string() + ": its ";
      const bool names_file = reason.starts_with(prefix);
      if (names_file) reason.remove_prefix(prefix.size());
      note("its " + std::string(is_embedded ? "embedded " : "") + "texture " +
           (is_embedded ? std::to_string(*index) : uri.substr(0, 200)) +
           (names_file ? " cannot be read: " : " ") + std::string(reason) +
           "; the material's colour is drawn instead");
      return kNoTexture;
    }
  }

  [[nodiscard]] std::int32_t texture_of(const GltfPart& part) const {
    if (!part.material || !part.has_texture_points) return kNoTexture;
    const auto found = texture_indices_.find(*part.material);
    return found == texture_indices_.end() ? kNoTexture : found->second;
  }

  void add_colours(const GltfScene& scene) {
    const auto has_colour = [](const GltfPart& part) { return part.material || part.has_colours; };
    if (std::none_of(scene.parts.begin(), scene.parts.end(), has_colour)) return;
    for (const GltfPart& part : scene.parts) {
      const BaseColour base = part.material ? colours_[*part.material] : BaseColour{};
      bool is_transparent = false;
      for (std::uint32_t i = 0; i < part.vertex_count; ++i) {
        Eigen::Vector4f colour = base.factor;
        if (part.has_colours) colour = colour.cwiseProduct(scene.colours[part.first_vertex + i]);
        const auto channel = [](float value) { return channel_of(srgb_of(std::max(value, 0.0F))); };
        model_.mesh.colours.push_back({channel(colour.x()), channel(colour.y()), channel(colour.z())});
        is_transparent =
            is_transparent || (part.has_colours && scene.colours[part.first_vertex + i].w() < 0.998F);
      }
      if (is_transparent && base.alpha != AlphaMode::kOpaque)
        not_drawn_.add("part", "drawn without the transparency of vertex colours");
    }
  }

  void add_texture_points(const GltfScene& scene) {
    for (const GltfPart& part : scene.parts) {
      const std::optional<TextureUse> use = part.material ? colours_[*part.material].texture : std::nullopt;
      if (use && !part.has_texture_points)
        not_drawn_.add("textured part without texture coordinates", "drawn in the material's colour");
      const std::int32_t texture = texture_of(part);
      for (std::uint32_t i = 0; i < part.vertex_count; ++i) {
        Eigen::Vector2f point = Eigen::Vector2f::Zero();
        if (texture != kNoTexture) point = use->image_from_set * scene.texture_points[part.first_vertex + i];
        model_.texture_points.push_back(point.allFinite() ? point : Eigen::Vector2f(Eigen::Vector2f::Zero()));
      }
      if (!model_.parts.empty() && model_.parts.back().texture == texture)
        model_.parts.back().triangle_count += part.triangle_count;
      else
        model_.parts.push_back({part.first_triangle, part.triangle_count, texture});
    }
    if (!model_.textures.empty()) return;
    model_.texture_points.clear();
    model_.parts.clear();
  }

  void name_the_rest_of_the_file() {
    for (const std::size_t material : used_) {
      name_the_rest(document_.element("materials", material), not_drawn_);
      const BaseColour& base = colours_[material];
      if (base.alpha != AlphaMode::kBlend) continue;
      const auto texture = texture_indices_.find(material);
      const bool has_shades =
          texture != texture_indices_.end() && texture->second != kNoTexture &&
          std::any_of(model_.textures[static_cast<std::size_t>(texture->second)].opacity.pixels.begin(),
                      model_.textures[static_cast<std::size_t>(texture->second)].opacity.pixels.end(),
                      [](std::uint8_t alpha) { return alpha != 0 && alpha != 255; });
      if (has_shades || base.factor.w() < 0.998F)
        not_drawn_.add("material", "half transparent, and drawn opaque from an alpha of 0.5 on");
    }
    if (const auto variants = document_.root().extension("KHR_materials_variants"))
      not_drawn_.add("variant of materials", "not offered; the default is drawn",
                     variants->size_of("variants"));
    for (const std::string& sentence : not_drawn_.sentences()) note(sentence);
    if (const std::string unknown = document_.unknown_extensions(); !unknown.empty())
      note("the glTF extension " + unknown + " is unknown; what it adds is not drawn");
  }
};

}  // namespace

Model read_gltf_model(const std::filesystem::path& path) { return Builder(path).build(); }

}  // namespace roomradar
