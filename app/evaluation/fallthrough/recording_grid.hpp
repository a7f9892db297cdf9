// recording_grid.hpp: an object dropped over each cell of a grid in a recorded room, under each policy.
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
  double radius_m = 0.04;  ///< of the ball that is dropped
  double below_m = 0.5;    ///< a ball that nothing stopped so far below the lowest surface has fallen
};

/// What became of one cell's ball under one policy.
struct GridDrop {
  double travelled_m = 0.0;
  SurfaceKind rested_on = SurfaceKind::kNothing;
};
struct GridCell {
  int column = 0, row = 0;
  Eigen::Vector3d start_world = Eigen::Vector3d::Zero();  ///< the ball's middle, in space that was seen free
  bool has_truth = false;                                 ///< the reference stops the ball
  double true_travel_m = 0.0;
  bool is_hidden = false;  ///< the camera does not see the true contact in this frame
  std::array<GridDrop, kPolicyCount> drops;
};
struct Grid {
  GridConfig config;
  int columns = 0, rows = 0;
  std::vector<GridCell> cells;  ///< those where the ball has a place to start from
};

/// Drops the ball from the highest place of each cell where it fits into space that the map knows as free,
/// below the camera's height; the surfaces are those of one frame.
/// @param reference_world  the surface that is taken as the truth
Grid drop_over_grid(GlContext& context, const SavedMap& map, const Frame& frame,
                    const Eigen::Isometry3d& T_world_camera, const Mesh& reference_world,
                    const GridConfig& config);

/// Passed, false and right as for scenarios; only cells with a truth, hidden ones or all.
struct GridTotals {
  int cells = 0, passed = 0, false_stops = 0;
  std::array<int, 6> rested_on{};  ///< by SurfaceKind
};
GridTotals totals_of(const Grid& grid, std::size_t policy, bool hidden_only);
std::string table_of(const Grid& grid);

/// The policies' plans side by side: each cell in the colour of what its ball rests on, ringed where it went
/// through the reference.
ColourImage draw_plan(const Grid& grid);

}  // namespace roomradar
