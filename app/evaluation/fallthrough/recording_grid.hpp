// recording_grid.hpp: drops an object over each cell of a grid in a recorded room, under each policy.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/policies.hpp"
#include "app/session/frame_scene.hpp"
#include "app/sim/scenarios/scenarios.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

struct GridConfig {
  double cell_m = 0.1;
  double radius_m = 0.04;  ///< radius of the dropped ball
  double below_m = 0.5;    ///< a ball this far below the lowest surface has fallen through
};

/// Result of one cell's ball under one policy.
struct GridDrop {
  double travelled_m = 0.0;  ///< distance fallen
  SurfaceKind rested_on = SurfaceKind::kNothing;
};
struct GridCell {
  int column = 0, row = 0;
  Eigen::Vector3d start_world = Eigen::Vector3d::Zero();  ///< centre of the ball, in observed free space
  bool has_truth = false;                                 ///< the reference surface stops the ball
  double true_travel_m = 0.0;
  bool is_hidden = false;  ///< the true contact is not visible in this frame
  std::array<GridDrop, kPolicyCount> drops;
};
struct Grid {
  GridConfig config;
  int columns = 0, rows = 0;
  std::vector<GridCell> cells;  ///< only cells with a free start position for the ball
};

/// Drops the ball in each cell from the highest position, below the camera's height, at which it fits into
/// the map's free space. Surfaces are those of one frame.
/// @param reference_world  surface used as ground truth
Grid drop_over_grid(GlContext& context, const SavedMap& map, const Frame& frame,
                    const Eigen::Isometry3d& T_world_camera, const Mesh& reference_world,
                    const GridConfig& config);

/// Numbers of cells with ground truth, of balls that passed through, and of false stops, by the same
/// thresholds as judge().
struct GridTotals {
  int cells = 0, passed = 0, false_stops = 0;
  std::array<int, 6> rested_on{};  ///< indexed by SurfaceKind
};
GridTotals totals_of(const Grid& grid, std::size_t policy, bool hidden_only);
std::string table_of(const Grid& grid);

/// Draws the policies' plans side by side: each cell has the colour of the surface that its ball rests on,
/// with a dark border if the ball passed through the reference surface.
ColourImage draw_plan(const Grid& grid);

}  // namespace roomradar
