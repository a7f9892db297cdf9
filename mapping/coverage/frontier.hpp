// frontier.hpp: finds the frontier between free and unknown space, and groups it into holes.
#pragma once
#include <vector>

#include "mapping/coverage/hole.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

struct FrontierConfig {
  double cell_m = 0.08;       ///< edge of the search grid's cells; at least the map's resolution
  double min_area_m2 = 0.06;  ///< smaller areas result from noise and edges
  double max_size_m = 1.5;    ///< larger holes are split
  /// A border cell is inside the scan if at least this fraction of rays from it into the unknown end at a
  /// surface.
  double min_enclosed = 0.5;
  /// A border cell with fewer such rays is still inside if its connected component's area is at most this
  /// fraction of the scan's cross section.
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

/// Reads the octree once into a grid of cells (coarser ones if there would be more than 16 million). A cell
/// is occupied if any of its voxels is, else free if half of it is. Border cells are unknown and share a face
/// with a free cell; adjacent border cells form one hole. Each face's area is projected along the border's
/// normal, so a slanted border's area is not that of its staircase. Returns no holes for an empty map. Throws
/// Error if the config is invalid.
Frontier find_frontier(const StaticMap& map, const FrontierConfig& config = {});

}  // namespace roomradar
