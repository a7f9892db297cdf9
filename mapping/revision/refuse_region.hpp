// refuse_region.hpp: erases a region of the static map and fuses it again from current frames.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Region around a set of points: all grid cells that contain a point, and their 26 neighbours.
class WorldRegion {
 public:
  /// @param cell_m  edge of a cell, m, > 0; every point is one to two cells inside the region's border
  WorldRegion(std::span<const Eigen::Vector3d> points_world, double cell_m);

  [[nodiscard]] bool contains(const Eigen::Vector3d& p_world) const;
  /// Returns the bounding box of all cells, m; empty if there are no points.
  [[nodiscard]] const Eigen::AlignedBox3d& box_world() const { return box_world_; }

 private:
  double cell_m_;
  Eigen::AlignedBox3d box_world_;
  std::unordered_set<std::uint64_t> cells_;
};

/// A frame, its pose, and the depth that the map predicts at this pose before it is revised.
struct RegionView {
  Frame frame;
  DepthImage expected_depth_m;  ///< same size as the frame's depth image; 0: the map has no surface there
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Updates a region of the map from the frames. Uses only pixels whose measured point is in the region, or
/// whose expected point is in the region and whose measured depth is beyond it.
///
/// Samples that more frames see through than measure become free, even behind the region, e.g. on the far
/// side of a removed object. Samples in the region that at least one frame measures, within the truncation
/// distance, are erased. Then the pixels are fused as in StaticMap::fuse(), which measures the erased samples
/// again.
///
/// @param views  frames of one static scene; pass several, because a single frame's noise becomes surface
/// @return the box (world, m) in which surface may have changed; empty if nothing changed
Eigen::AlignedBox3d refuse_region(StaticMap& map, const WorldRegion& region,
                                  std::span<const RegionView> views);

}  // namespace roomradar
