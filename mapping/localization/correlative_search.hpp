// shape_search.hpp: where a camera may stand by the shape of what it sees.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// How near surfaces are, on a grid of cubes.
struct ShapeGrid {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< m, the first cube's corner, in the world
  double cell_m = 0.0;
  std::array<int, 3> size{};           ///< cubes along x, y, z
  std::vector<std::uint8_t> nearness;  ///< x fastest; kOnSurface in a cube with a surface, down to 0
  static constexpr int kOnSurface = 255;
  static constexpr int kReach_cells = 3;  ///< so far from a surface nearness is 0
};

/// What the places' previews show, to be searched with propose_by_shape: coarse for all of the room, and
/// fine.
struct KnownShape {
  ShapeGrid coarse, fine;
  [[nodiscard]] bool empty() const { return coarse.nearness.empty(); }
};
/// Cubes are of 15 cm and 7.5 cm, larger in a room that would have more than 500,000 of the coarse ones.
KnownShape known_shape(const Places& places);

struct ShapeCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  double nearness = 0.0;  ///< mean of what the depth's points meet, from 1, all lie on surfaces, down to 0
};

/// The poses at which most points of the depth image lie on known surfaces, the best first, none twice: all
/// positions in the room and all headings are tried on the coarse grid; tilt and roll are gravity's.
/// Deterministic. Nothing if the depth has next to no measurement or down_camera is not a direction.
/// Source: Olson, Real-Time Correlative Scan Matching, ICRA 2009.
///
/// @param down_camera  direction of gravity in the camera's frame; in the world it is -z
std::vector<ShapeCandidate> propose_by_shape(const DepthImage& depth_m, const Intrinsics& camera,
                                             const Eigen::Vector3d& down_camera, const KnownShape& known,
                                             std::size_t most);

}  // namespace roomradar
