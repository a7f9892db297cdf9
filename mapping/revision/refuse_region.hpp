// refuse_region.hpp: replaces surface in a region of the static map by the surface in current frames.
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
  /// @param cell_m  edge of a cell, m, > 0. Every point is at least one cell inside the region's border
  WorldRegion(std::span<const Eigen::Vector3d> points_world, double cell_m);

  [[nodiscard]] bool contains(const Eigen::Vector3d& p_world) const;
  /// Returns the bounding box of all cells, m; empty if there are no points.
  [[nodiscard]] const Eigen::AlignedBox3d& box_world() const { return box_world_; }

 private:
  double cell_m_;
  Eigen::AlignedBox3d box_world_;
  std::unordered_set<std::uint64_t> cells_;
};

/// A frame, its pose, and the depth that the map predicts at this pose before the revision.
struct RegionView {
  Frame frame;
  DepthImage expected_depth_m;  ///< same size as the frame's depth image; 0: no surface in the map
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Updates a region of the map from the frames. Uses pixels whose measured point is in the region. Also uses
/// pixels whose expected point is in the region and whose measured depth is larger than the expected depth.
///
/// A sample is erased and its voxel becomes free if more frames see through the sample than measure it. The
/// same rule applies to samples up to 1 m behind the region, e.g. on the far side of a removed object. A
/// sample in the region is erased if at least one frame measures a surface within the truncation distance of
/// it. Then the selected pixels are fused as in StaticMap::fuse(). This measures the erased samples again.
///
/// @param views  frames of one static scene. Pass several, since the noise of a single frame would become
///               surface
/// @return the box (world frame, m) in which surface may have changed; empty if nothing changed. Ignores
///         pixels fused more than 1 m outside the region's box
Eigen::AlignedBox3d refuse_region(StaticMap& map, const WorldRegion& region,
                                  std::span<const RegionView> views);

}  // namespace roomradar
