// recording_grid.hpp: drops a ball in each cell of a horizontal grid in a recorded room, with each policy.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/policies.hpp"
#include "app/session/frame_scene.hpp"
#include "app/sim/scenarios/scenarios.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/image.hpp"

#include "radar/exact/radar_query.hpp"

namespace roomradar {

struct GridConfig {
  double cell_m = 0.1;
  RadarMode radar = RadarMode::kExact;  ///< the radar that drops the balls
  double radius_m = 0.04;  ///< radius of the ball
  double below_m = 0.5;    ///< a ball farther than this below the lowest surface has fallen through
};

/// Result of one cell's drop with one policy.
struct GridDrop {
  double travelled_m = 0.0;  ///< distance fallen
  SurfaceKind rested_on = SurfaceKind::kNothing;
};
struct GridCell {
  int column = 0, row = 0;
  /// Start position of the ball's centre, in observed free space.
  Eigen::Vector3d start_world = Eigen::Vector3d::Zero();
  bool has_truth = false;  ///< true if the reference surface stops the ball
  double true_travel_m = 0.0;
  /// True if the contact point on the reference surface is not visible in the frame, or there is no contact.
  bool is_hidden = false;
  std::array<GridDrop, kPolicyCount> drops;
};
struct Grid {
  GridConfig config;
  int columns = 0, rows = 0;
  std::vector<GridCell> cells;  ///< cells with a free start position for the ball
};

/// Drops the ball in each cell onto the surfaces of one frame. The start is the highest position below the
/// camera's height at which the ball fits into the map's observed free space.
/// @param reference_world  surface used as ground truth
Grid drop_over_grid(GlContext& context, const SavedMap& map, const Frame& frame,
                    const Eigen::Isometry3d& T_world_camera, const Mesh& reference_world,
                    const GridConfig& config);

/// Counts of cells, balls that passed through, and false stops over a grid's cells with has_truth. The
/// thresholds are those of judge().
struct GridTotals {
  int cells = 0, passed = 0, false_stops = 0;
  int false_stops_at_unknown = 0;  ///< false stops on the frontier of unknown space
  std::array<int, 6> rested_on{};  ///< number of balls, indexed by SurfaceKind
};
GridTotals totals_of(const Grid& grid, std::size_t policy, bool hidden_only);
std::string table_of(const Grid& grid);

/// Draws one plan of the grid per policy, side by side. A cell's colour shows the surface kind on which its
/// ball rests. The colour is pale unless GridCell::is_hidden. A dark outline marks a ball that passed through
/// the reference surface.
ColourImage draw_plan(const Grid& grid);

}  // namespace roomradar
