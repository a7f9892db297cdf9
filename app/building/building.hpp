// building.hpp: one map of a building, from many recordings.
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

/// How many jobs a stage had, and how they ended.
struct StageCounts {
  std::string stage;
  std::size_t done = 0, present = 0, failed = 0;
  double wall_s = 0.0, cpu_s = 0.0;
  double peak_mb = 0.0;  ///< of the job with the highest memory, 10^6 bytes
  std::vector<std::string> faults;
};

struct JoinedPair {
  SubmapName a, b;
  SubmapJoin join;
  bool is_used = false;  ///< false: contradicts other joins, or was refused before
  double off_m = 0.0;    ///< from the solution
};

struct BuildingResult {
  BuildingInfo info;
  std::vector<StageCounts> stages;
  std::vector<JoinedPair> joins;
  std::size_t kept = 0;  ///< submaps whose poses did not change since the last time
  /// Error of all placed frames' positions against recorded poses, after one rigid alignment of the whole;
  /// no poses if the recordings state none. The recorded poses must be in one world.
  TrajectoryError recorded_error;
};

/// Makes a building's map, or brings it up to date:
///   track     each recording alone: a submap
///   retrieve  pairs of recordings that may show the same place
///   join      proof that they do, and their relative pose
///   (place)   all recordings in one world
///   fuse      each recording's frames with its final poses, split into tiles
///   tile      the parts of each tile added up; its surface
/// What is there for the same inputs is not done again. Recordings that cannot be tracked, or that no other
/// recording meets, are left out and listed. building.json is replaced at the end, then files of earlier
/// tiles are deleted.
/// @param show  called with one sentence after each stage
/// @throws Error if no recording can be tracked, a tile or a fusion fails, or a file cannot be written
BuildingResult build_building(const BuildingWork& work, const RunStage& run_stage,
                              const std::function<void(const std::string&)>& show);

}  // namespace roomradar
