// material.hpp: procedural surface patterns as functions of surface coordinates in metres.
#pragma once
#include <array>
#include <cstdint>

#include "mapping/types/image.hpp"

namespace roomradar {

enum class Pattern {
  /// One colour with fine speckles.
  kPortable,
  /// Wall paint: speckles and faint blotches.
  kPlaster,
  /// Wood with its grain along u.
  kWood,
  /// Floor boards along u, each with its own grain.
  kPlanks,
  /// Square tiles separated by joints.
  kTiles,
  /// Carpet with a woven border and ornaments.
  kCarpet,
  /// Poster: shapes on a plain background. The seed determines the shapes.
  kPoster,
  /// Landscape: sky, hills and meadow.
  kLandscape,
  /// Back of a book: bands and letters.
  kSpine,
  /// Weave with stripes.
  kFabric,
  /// Speckled stone.
  kStone,
  /// Skin of hands and faces.
  kSkin,
  /// Centred checkerboard with squares of side kCheckerSquare_m. Its margin is at least half a square wide.
  kChecker,
};

inline constexpr float kCheckerSquare_m = 0.06F;

struct Material {
  Pattern pattern = Pattern::kPortable;
  Rgb first{200, 200, 200};
  Rgb second{120, 120, 120};
  std::uint32_t seed = 0;
  /// Reflected fraction of the projector's infrared light. Low for dark or glossy surfaces.
  float infrared = 0.6F;
};

/// Returns the colour of point (u_m, v_m) of a face of the given size, as gamma-encoded red, green and blue,
/// 0 to 1. (0, 0) is the face's centre. v points up on vertical faces.
std::array<float, 3> pattern_colour(const Material& material, float u_m, float v_m, float width_m,
                                    float height_m);

}  // namespace roomradar
