// refuse_region.hpp: erases part of the static map and fuses it again from frames of its current state.
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

/// The space around a set of points: cells that contain a point, and their neighbours.
class WorldRegion {
 public:
  /// @param cell_m  cell size, m, > 0; points are one to two cells inside the region's border
  WorldRegion(std::span<const Eigen::Vector3d> points_world, double cell_m);

  [[nodiscard]] bool contains(const Eigen::Vector3d& p_world) const;
  /// Bounds of all cells; empty without points.
  [[nodiscard]] const Eigen::AlignedBox3d& box_world() const { return box_world_; }

 private:
  double cell_m_;
  Eigen::AlignedBox3d box_world_;
  std::unordered_set<std::uint64_t> cells_;
};

/// A frame, its pose, and the depth of the map's surface there before the change.
struct RegionView {
  Frame frame;
  DepthImage expected_depth_m;  ///< same size as the frame's depth; 0: no surface in the map
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Fuses the map again where frames differ from it, only at pixels whose measured or expected point is in the
/// region. First erases old data: samples that most frames see through become free, also behind the region
/// (the far side of a removed object). Samples in the region that frames measure, or right behind what they
/// measure, are erased to be measured again. Then fuses the selected pixels as StaticMap::fuse() does. Other
/// pixels change nothing.
///
/// @param views  frames of one static scene; several, because a single frame turns its noise into surface
/// @return the box (world) in which surface may have appeared or disappeared; empty if nothing changed
Eigen::AlignedBox3d refuse_region(StaticMap& map, const WorldRegion& region,
                                  std::span<const RegionView> views);

}  // namespace roomradar
