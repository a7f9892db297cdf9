// coverage.hpp: unobserved regions of a scan, and a picture of its coverage.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/coverage/holes.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

struct Coverage {
  std::vector<Hole> holes;                ///< largest first; outer borders last
  std::vector<std::uint8_t> picture_png;  ///< drawn by draw_coverage(), as a PNG file
};

/// Finds the holes of a finished map and draws its coverage. Takes a few tenths of a second for a room.
Coverage survey_coverage(const StaticMap& octree, const Mesh& mesh, const std::vector<TimedPose>& trajectory);

}  // namespace roomradar
