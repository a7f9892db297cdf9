// coverage.hpp: what a scan has seen of its room, and what it has not.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/holes.hpp"
#include "mapping/map_folder.hpp"

namespace roomradar {

struct Coverage {
  std::vector<Hole> holes;  ///< unknown space, surface borders, outer borders; each largest first
  std::vector<std::uint8_t> picture_png;  ///< as draw_coverage draws it
};

/// Of a finished map: its octree, mesh and trajectory. Some tenths of a second for a room.
Coverage survey_coverage(const SavedMap& map);

}  // namespace roomradar
