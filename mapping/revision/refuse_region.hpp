// region_renewal.hpp: a part of the static map forgotten, and made anew from frames that see it as it is now.
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

/// The space round a set of points: the cells that hold one, and those that touch such a cell.
class WorldRegion {
 public:
  /// Cells of the size given (m, > 0); a point is within one to two of them from the region's border.
  WorldRegion(std::span<const Eigen::Vector3d> points_world, double cell_m);

  [[nodiscard]] bool contains(const Eigen::Vector3d& p_world) const;
  /// Of all cells; empty without points.
  [[nodiscard]] const Eigen::AlignedBox3d& box_world() const { return box_world_; }

 private:
  double cell_m_;
  Eigen::AlignedBox3d box_world_;
  std::unordered_set<std::uint64_t> cells_;
};

/// A frame, where it was taken, and what the map's surface showed there before the change.
struct RegionView {
  Frame frame;
  DepthImage expected_depth_m;  ///< of the depth camera's size; 0 = the map has nothing there
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Makes the map anew where frames see something else than it has: at pixels whose measured point or whose
/// expected point lies in the region, and nowhere else. First what is known there is forgotten: samples that
/// most frames see through become free, also behind the region (the far side of what was taken away), and
/// those in the region that the frames see, or that lie right behind what they see, are measured anew. Then
/// the frames' pixels are fused as by StaticMap::fuse. Pixels elsewhere change nothing.
///
/// @param views  frames of one static scene; a single one makes a surface of its noise
/// @return the box (world) in which surface may have come or gone; empty if nothing was changed
Eigen::AlignedBox3d renew_region(StaticMap& map, const WorldRegion& region,
                                 std::span<const RegionView> views);

}  // namespace roomradar
