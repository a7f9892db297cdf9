// correlative_search.hpp: finds camera pose candidates from depth alone, by correlative scan matching.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mapping/localization/keyframe_database.hpp"

namespace roomradar {

/// Truncated distance transform of surfaces on a grid of cubes, stored inverted as nearness.
struct ShapeGrid {
  Eigen::Vector3d low = Eigen::Vector3d::Zero();  ///< lower corner of the first cube, in the world frame, m
  double cell_m = 0.0;
  std::array<int, 3> size{};  ///< number of cubes along x, y and z
  /// Nearness by cube, x fastest, then y, then z. Nearness is kOnSurface in a cube with a surface, and
  /// decreases linearly to 0 with the distance from the surface.
  std::vector<std::uint8_t> nearness;
  static constexpr int kOnSurface = 255;
  static constexpr int kReach_cells = 3;  ///< distance from a surface, in cubes, at which nearness is 0
};

/// Surfaces in the downsampled depth images of all keyframes of a database, for search_by_shape(). The coarse
/// grid is for searching the whole room, the fine grid for refining poses.
struct ShapeIndex {
  ShapeGrid coarse, fine;
  [[nodiscard]] bool empty() const { return coarse.nearness.empty(); }
};
/// Builds the index. The cubes' edges are 15 cm (coarse) and 7.5 cm (fine), or longer if a room would need
/// more than 500,000 coarse cubes.
ShapeIndex shape_index(const KeyframeDatabase& keyframe_database);

struct ShapeCandidate {
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  double nearness = 0.0;  ///< mean nearness of the image's points, 0..1; 1: all are on surfaces
};

/// Returns at most `most` distinct poses with the highest mean nearness of the depth image's points to known
/// surfaces, best first. Searches all positions in the room and all headings on the coarse grid. Tilt and
/// roll come from gravity. Deterministic. Returns an empty vector if almost no depth is valid or down_camera
/// is not a unit vector. Source: Olson, Real-Time Correlative Scan Matching, ICRA 2009.
///
/// @param down_camera  unit direction of gravity in the camera's frame (-z in the world frame)
std::vector<ShapeCandidate> search_by_shape(const DepthImage& depth_m, const Intrinsics& camera,
                                            const Eigen::Vector3d& down_camera, const ShapeIndex& known,
                                            std::size_t most);

/// The same for a point cloud, such as the surface of a whole scan, instead of an image.
/// @param points  relative to a position within the known room, e.g. of a camera, m
/// @param down    unit direction of gravity in the points' frame
/// @return poses of the points' frame in the world frame
std::vector<ShapeCandidate> search_by_shape(const std::vector<Eigen::Vector3f>& points,
                                            const Eigen::Vector3d& down, const ShapeIndex& known,
                                            std::size_t most);

}  // namespace roomradar
