// frontier.hpp: finds the frontier between free and unknown space, and groups its border cells (unknown cells
// that share a face with a free cell) into holes.
#pragma once
#include <vector>

#include "mapping/coverage/holes.hpp"
#include "mapping/coverage/occupancy_cells.hpp"

namespace roomradar {

struct FrontierConfig {
  double cell_m = 0.08;       ///< edge of the search grid's cells; at least the map's resolution
  double min_area_m2 = 0.06;  ///< smaller holes are ignored as noise
  double max_size_m = 1.5;    ///< max distance of a hole's cells from its first cell
  /// A border cell is inside the scan if at least this fraction of the rays from the cell into unknown space
  /// end at a surface.
  double min_enclosed = 0.5;
  /// Border cells below min_enclosed are inside, too, if the area of their connected component is at most
  /// this fraction of the area of the scan's bounding box, seen along the component's mean normal.
  double max_open_part = 0.08;
};

/// Throws Error naming field, value and rule.
void require_valid(const FrontierConfig& config);

/// A border cell, for drawing.
struct FrontierCell {
  Eigen::Vector3d centre_world = Eigen::Vector3d::Zero();
  int hole = -1;  ///< index in Frontier::holes; -1: its component is too small
};

struct Frontier {
  double cell_m = 0.0;      ///< edge of the cells, a multiple of the map's resolution
  std::vector<Hole> holes;  ///< kUnknownSpace, then kOuterBorder; per kind, largest first
  std::vector<FrontierCell> cells;
};

/// Finds the border cells. Connected border cells of one kind (inside the scan, or at its end) form one hole,
/// limited by max_size_m. A hole's area sums its faces projected along the border's normal, since the faces
/// of a slanted border form a staircase with a larger area. Returns no holes if no cell is occupied. Throws
/// Error if the config is invalid. Uses grid.cell_m instead of FrontierConfig::cell_m.
Frontier find_frontier(const OccupancyCells& grid, const FrontierConfig& config = {});
/// As above, in the octree's occupancy_cells().
Frontier find_frontier(const StaticMap& map, const FrontierConfig& config = {});

}  // namespace roomradar
