// model.hpp: the mesh of a virtual object with the textures of its author.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Continuation of a texture beyond its border.
enum class TextureWrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// A base-colour texture.
struct Texture {
  ColourImage colour;                ///< sRGB
  MaskImage opacity;                 ///< 0..255, same size as colour; empty: opaque everywhere
  std::uint8_t least_opacity = 128;  ///< less opaque pixels are not drawn
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;
  friend bool operator==(const Texture& a, const Texture& b) {
    return a.colour.width == b.colour.width && a.colour.pixels == b.colour.pixels &&
           a.opacity.pixels == b.opacity.pixels && a.least_opacity == b.least_opacity &&
           a.wrap_u == b.wrap_u && a.wrap_v == b.wrap_v;
  }
};

inline constexpr std::int32_t kNoTexture = -1;

/// Consecutive triangles with the same texture.
struct ModelPart {
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  std::int32_t texture = kNoTexture;  ///< index in Model::textures
  friend bool operator==(const ModelPart&, const ModelPart&) = default;
};

/// Vertex colours hold material colour times vertex colour, sRGB; a texture multiplies them. Vertices at
/// texture seams are there once per side.
struct Model {
  Mesh mesh;
  std::vector<Eigen::Vector2f> texture_points{};  ///< empty without textures, else one per vertex: 0..1 from
                                                  ///< the texture's top left, right and down
  std::vector<ModelPart> parts{};                 ///< empty without textures, else all triangles in order
  std::vector<Texture> textures{};
  std::vector<std::string> notes{};  ///< sentences for the user: what of the file could not be used

  [[nodiscard]] bool is_textured() const { return !textures.empty(); }
};

}  // namespace roomradar
