// building_paint.hpp: materials of corridors and stairwells, drawn by seed.
#pragma once
#include <cstdint>

#include "app/sim/building/building_walls.hpp"

namespace roomradar {

/// Returns paint in a hue drawn from `seed`. `look` seeds its texture.
WallPaint wall_paint(std::uint64_t seed, std::uint32_t look);
/// Returns a floor covering: tiles, planks, stone or fabric.
Material floor_covering(std::uint64_t seed, std::uint32_t look);
/// Returns a saturated colour, as used for door frames.
Material lacquer(std::uint64_t seed, std::uint32_t look);
/// Returns a poster or landscape.
Material picture_of(std::uint32_t look);
Material frame_of(std::uint32_t look);

}  // namespace roomradar
