// correlative_search.hpp: camera pose hypotheses from depth alone, by correlative search.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Nearness to surfaces on a grid of cubes.
struct ShapeGrid {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< m, lower corner of the first cube, in the world
  double cell_m = 0.0;
  std::array<int, 3> size{};           ///< number of cubes along x, y, z
  std::vector<std::uint8_t> nearness;  ///< x fastest; kOnSurface in a cube with a surface, decreasing to 0
  static constexpr int kOnSurface = 255;
  static constexpr int kReach_cells = 3;  ///< distance from a surface at which nearness is 0
};

/// Surfaces in the database's previews, for search_by_shape: a coarse grid to search the whole room, and a
/// fine grid to refine poses.
struct ShapeIndex {
  ShapeGrid coarse, fine;
  [[nodiscard]] bool empty() const { return coarse.nearness.empty(); }
};
/// The cubes' edges are 15 cm and 7.5 cm, or larger in a room that would need more than 500,000 coarse cubes.
ShapeIndex shape_index(const KeyframeDatabase& keyframe_database);

struct ShapeCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  double nearness = 0.0;  ///< mean nearness of the depth's points, 0..1; 1: all are on surfaces
};

/// Returns distinct poses at which the most points of the depth image lie on known surfaces, best first.
/// Searches all positions in the room and all headings on the coarse grid; tilt and roll come from gravity.
/// Deterministic. Empty if almost no depth is valid or down_camera is not a unit vector. Source: Olson,
/// Real-Time Correlative Scan Matching, ICRA 2009.
///
/// @param down_camera  direction of gravity in the camera's frame; in the world it is -z
std::vector<ShapeCandidate> search_by_shape(const DepthImage& depth_m, const Intrinsics& camera,
                                            const Eigen::Vector3d& down_camera, const ShapeIndex& known,
                                            std::size_t most);

}  // namespace roomradar
