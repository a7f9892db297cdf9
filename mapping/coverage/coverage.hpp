// coverage.hpp: unobserved regions of a scan, and a picture of its coverage from above and from two sides.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/coverage/frontier.hpp"
#include "mapping/coverage/holes.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// Max standard deviation, m, of the signed distances of surface that counts as well observed. The standard
/// deviation is computed from the samples' weights. About 4 frames from a distance of 2 m suffice, or 22
/// frames from 3 m.
inline constexpr double kSeenWell_m = 0.003;

/// Draws orthographic projections of the surface from above and from two sides. Back faces are left out, so
/// walls and ceiling do not hide the room. The view is rotated about the vertical so that most walls run
/// along the picture's axes. Arrows show the axes of the world frame. Surface that is not well observed is
/// orange. Border cells of holes are violet (unknown space) or blue (end of the scan). The first 12 holes are
/// numbered from 1, in the order of `holes`. A line shows the camera's path. The picture includes scale and
/// legend, and has about 1600 x 1000 pixels. For an empty surface, the picture says that there is none.
ColourImage draw_coverage(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                          std::span<const Hole> holes, std::span<const TimedPose> trajectory);

struct Coverage {
  std::vector<Hole> holes;                ///< largest first; outer borders last
  std::vector<std::uint8_t> picture_png;  ///< drawn by draw_coverage(), as a PNG file
};

/// Finds the holes of a finished map and draws its coverage. Takes a few tenths of a second for a room.
Coverage survey_coverage(const StaticMap& octree, const Mesh& mesh, const std::vector<TimedPose>& trajectory);

}  // namespace roomradar
