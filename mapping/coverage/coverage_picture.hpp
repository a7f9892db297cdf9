// coverage_picture.hpp: draws a scan's coverage from above and from two sides.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/coverage/frontier.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// Max standard deviation of a well observed surface's distance, from the samples' weights: 3 frames from 2
/// m, or 15 from 3 m.
inline constexpr double kSeenWell_m = 0.003;

/// Draws orthographic projections of the surface from above and from two sides. Back faces are left out, so
/// walls and ceiling do not hide the room. The view is rotated about the vertical so most walls run along the
/// picture's axes; arrows show the world's axes. Thinly observed surface is orange. Cells at the borders of
/// holes are violet (unknown space, surface borders) or blue (end of the scan). The largest holes are
/// numbered by their place in `holes`, from 1, and a line shows the camera's path. With scale and legend,
/// about 1600 x 1000 pixels. An empty surface gives a picture that says so.
ColourImage draw_coverage(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                          std::span<const Hole> holes, std::span<const TimedPose> trajectory);

/// Encodes a picture as a PNG file's bytes. Throws Error if the picture is empty.
std::vector<std::uint8_t> encode_png(const ColourImage& picture);

}  // namespace roomradar
