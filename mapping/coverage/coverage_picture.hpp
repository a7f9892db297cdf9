// coverage_picture.hpp: a scan's room from above and from two sides: seen well, seen thinly, not seen.
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

/// Surface whose distance is known to less than this (standard deviation, from the weights of the samples) is
/// seen well: that takes 3 frames from 2 m, 15 from 3 m.
inline constexpr double kSeenWell_m = 0.003;

/// Draws the surface straight from above and from two sides, each as if what stands between the viewer and
/// the inside of the room were not there (back faces are left out). The picture is turned so that most walls
/// are upright in it; arrows show the world's axes. Where the surface was seen thinly it is orange; border
/// cells of holes are marked, violet for unknown space and surface borders, blue where the scan ends; the
/// largest holes have their numbers (1: the first of `holes`). The camera's way is a line. With scale and
/// legend; some 1600 x 1000 pixels. An empty surface gives a picture that says so.
ColourImage draw_coverage(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                          std::span<const Hole> holes, std::span<const TimedPose> trajectory);

/// As a PNG file's bytes.
std::vector<std::uint8_t> encode_png(const ColourImage& picture);

}  // namespace roomradar
