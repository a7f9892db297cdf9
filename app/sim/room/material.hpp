// material.hpp: procedural surface patterns, with coordinates in metres.
#pragma once
#include <array>
#include <cstdint>

#include "mapping/types/image.hpp"

namespace roomradar {

enum class Pattern {
  kPortable,   ///< one colour with fine speckle
  kPlaster,    ///< wall paint: speckle, faint blotches
  kWood,       ///< grain along u
  kPlanks,     ///< floor boards along u, each with its own grain
  kTiles,      ///< square tiles with joints
  kCarpet,     ///< woven border and ornaments
  kPoster,     ///< shapes on a ground, different for each seed
  kLandscape,  ///< sky, hills and meadow
  kSpine,      ///< book: bands and letters
  kFabric,     ///< weave with stripes
  kStone,      ///< speckled stone
  kSkin,       ///< for hands and faces
  kChecker,    ///< checkerboard with squares of kCheckerSquare_m, centred, with a margin at least half a
               ///< square wide
};

inline constexpr float kCheckerSquare_m = 0.06F;

struct Material {
  Pattern pattern = Pattern::kPortable;
  Rgb first{200, 200, 200};
  Rgb second{120, 120, 120};
  std::uint32_t seed = 0;
  float infrared = 0.6F;  ///< reflected fraction of the projector's light; low for dark or glossy surfaces
};

/// Returns the colour (gamma-encoded, 0 to 1) of a point on a face of the given size. (u, v) is in metres
/// from the face's centre; v is up on upright faces.
std::array<float, 3> pattern_colour(const Material& material, float u_m, float v_m, float width_m,
                                    float height_m);

}  // namespace roomradar
