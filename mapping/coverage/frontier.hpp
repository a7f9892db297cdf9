// frontier.hpp: the border between free and unknown space: where a scan has not looked.
#pragma once
#include <vector>

#include "mapping/coverage/holes.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

struct FrontierConfig {
  double cell_m = 0.08;       ///< of the grid that is searched; at least the map's voxels
  double min_area_m2 = 0.06;  ///< less is what noise and edges leave
  double max_size_m = 1.5;    ///< what is larger is listed in parts
  /// A border cell lies inside the scan if so many of the ways from it into the unknown end at a surface ...
  double min_enclosed = 0.5;
  /// ... and otherwise if all that hangs together there is less than this part of the scan's cross section.
  double max_open_part = 0.08;
};

/// Throws Error naming field, value and rule.
void require_valid(const FrontierConfig& config);

/// A cell of the border, for drawing.
struct FrontierCell {
  Eigen::Vector3d middle_world = Eigen::Vector3d::Zero();
  int hole = -1;  ///< which of Frontier::holes it is part of; -1: of none, for it is too small
};

struct Frontier {
  double cell_m = 0.0;      ///< edge of the cells, a whole number of the map's voxels
  std::vector<Hole> holes;  ///< kUnknownSpace and, where the scan ends, kOuterBorder; each kind largest first
  std::vector<FrontierCell> cells;
};

/// The octree is read once into a grid of cells (coarser ones if there would be more than 16 million):
/// occupied where any voxel is, else free where half of the cell is. Border cells are unknown and share a
/// face with a free one; those that touch are one hole. An area counts each face by its share in the border's
/// slope, so that a slanted border is not counted as its steps. An empty map has none. Throws Error if the
/// config is out of its rules.
Frontier find_frontier(const StaticMap& map, const FrontierConfig& config = {});

}  // namespace roomradar
