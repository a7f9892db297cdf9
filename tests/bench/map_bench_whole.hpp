// map_bench_whole.hpp: cost and accuracy of scanning a whole recording, with coarse cells and with voxels
// only.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "mapping/octree/fusion_config.hpp"

namespace roomradar::test {

struct WholeCell {
  std::string source;  ///< recording with poses, or sim:ROOM
  std::string truth;   ///< the same frames without noise; empty: the held-out frames of `source`
  double resolution_m = 0.01;
  double max_cell_sigmas = FusionConfig{}.max_cell_sigmas;  ///< of the map compared with voxels only
  int submap_frames = 0;  ///< frames of a submap; 0: no map is merged from submaps
};

/// Fuses all frames with a pose but every 20th into two maps, one with voxels only, frame by frame in turn.
/// Then intersects rays of the held-out frames with the zero crossing of each map's signed distance. Times
/// are CPU times of this thread. Returns one row per map: ms per frame (median, p95), megabytes of the
/// octree, and per 0.5 m of depth the rays, the median of the absolute error, the bias and the share of rays
/// without a crossing within 15 cm. With submap_frames, a third map is merged from submaps with coarse cells.
/// Each is fused in the frame of its first camera, as if its pose were found later. Times are then those of
/// merging, per submap.
nlohmann::json whole_rows(const WholeCell& cell);

/// Runs `roomradar prescan` on a source, with default settings. Returns its time, the time from the last
/// frame to the saved map, the peak of its memory, the size of the map's folder, the trajectory's error, and
/// the median time of its stages; then the time and the peak of `roomradar run` in this map up to its first
/// composed picture. Throws Error if the program fails.
nlohmann::json scan_row(const std::string& source);

/// Prints the rows of whole_rows() as a table.
void print_whole(const nlohmann::json& rows);

}  // namespace roomradar::test
