// building.hpp: builds one map of a building from many recordings.
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "app/building/building_stages.hpp"
#include "app/farm/farm.hpp"
#include "mapping/building/building_graph.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// Runs a stage's jobs, on this machine or on the ranks of an MPI program. `stage` is "track", "retrieve",
/// "join", "fuse" or "tile".
using RunStage = std::function<FarmState(const std::string& stage, const FarmPlan& plan)>;

/// Number of a stage's jobs, by outcome, and their cost.
struct StageCounts {
  std::string stage;
  std::size_t done = 0, present = 0, failed = 0;
  double wall_s = 0.0, cpu_s = 0.0;
  double peak_mb = 0.0;  ///< max memory of a job, 10^6 bytes
  std::vector<std::string> faults;
};

struct JoinedPair {
  SubmapName a, b;
  SubmapJoin join;
  /// False: the join failed its verification (SubmapJoin::status), or contradicts other joins.
  bool is_used = false;
  double off_m = 0.0;  ///< see BuildingGraph::off_m
};

struct BuildingResult {
  BuildingInfo info;
  std::vector<StageCounts> stages;
  std::vector<JoinedPair> joins;
  std::size_t kept = 0;  ///< number of submaps whose poses in the building are those of the last run
  /// Position error of all placed frames (frames of submaps in the map) against the recorded poses, after one
  /// rigid alignment. Empty if the recordings contain no poses. Precondition: all recorded poses are in one
  /// world frame.
  TrajectoryError recorded_error;
};

/// Makes a building's map, or brings it up to date. The stages:
///   track     tracks each recording alone, which gives its submaps
///   retrieve  finds pairs of submaps that may show the same place
///   join      verifies these pairs, and measures their relative poses
///   (place)   solves for the poses of all submaps in one world frame; not a job
///   fuse      fuses each recording's frames with its final poses, and splits the result into tiles
///   tile      merges the parts of each tile, and extracts its surface
/// Jobs whose inputs have not changed are not run again. Recordings that cannot be tracked, or that no join
/// connects with the others, are omitted from the map and listed in the result. At the end, building.json is
/// replaced, then the files of earlier tiles and keyframes are deleted.
/// @param show  called with one sentence after each stage
/// @throws Error if no recording can be tracked, a job of a later stage fails, a stage is stopped, or a file
///         cannot be written
BuildingResult build_building(const BuildingWork& work, const RunStage& run_stage,
                              const std::function<void(const std::string&)>& show);

}  // namespace roomradar
