// model.hpp: the mesh of a virtual object with its textures.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Continuation of a texture for texture coordinates outside 0..1.
enum class TextureWrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// A base-colour texture.
struct Texture {
  ColourImage colour;                ///< sRGB
  MaskImage opacity;                 ///< alpha, 0..255, same size as colour; empty: opaque everywhere
  std::uint8_t least_opacity = 128;  ///< alpha cutoff: pixels with a lower alpha are not drawn
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
  bool is_pixelated = false;  ///< magnified pixels are drawn as squares, not blended with their neighbours
  friend bool operator==(const Texture& a, const Texture& b) {
    return a.colour.width == b.colour.width && a.colour.pixels == b.colour.pixels &&
           a.opacity.pixels == b.opacity.pixels && a.least_opacity == b.least_opacity &&
           a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v && a.is_pixelated == b.is_pixelated;
  }
};

/// Value of ModelPart::texture for triangles without a texture.
inline constexpr std::int32_t kNoTexture = -1;

/// Consecutive triangles with the same texture.
struct ModelPart {
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::int32_t texture = kNoTexture;  ///< index in Model::textures
  friend bool operator==(const ModelPart&, const ModelPart&) = default;
};

/// Mesh colours are material colours times vertex colours, in sRGB. Textures multiply them. Vertices at
/// texture seams are duplicated, one per side.
struct Model {
  Mesh mesh;
  /// Texture coordinates, one per vertex; empty without textures. (0, 0) is the texture's top left corner,
  /// (1, 1) its bottom right corner.
  std::vector<Eigen::Vector2f> texture_points{};
  /// Parts that cover all triangles, in order; empty without textures.
  std::vector<ModelPart> parts{};
  std::vector<Texture> textures{};
  /// Sentences for the user about contents of the file that could not be used.
  std::vector<std::string> notes{};

  [[nodiscard]] bool is_textured() const { return !textures.empty(); }
};

}  // namespace roomradar
