// building_command.hpp: options and execution of `roomradar building` and of its jobs.
#pragma once
#include <functional>
#include <string>

#include "app/building/building.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct BuildingOptions {
  std::string folder;
  std::string recordings;  ///< path of the list; see read_recording_list()
  TileGrid grid;
  double deviation_m = 0.002;
  PoseOrigin poses = PoseOrigin::kAuto;
  int processes = 0;  ///< max number of concurrent jobs; 0: one per processor
  std::string report;
};
/// Adds the options with their help texts and checks.
void add_options(CLI::App& command, BuildingOptions& options);
/// Executes the command on this machine's processors. Returns the exit status.
int run(const BuildingOptions& options);
/// Executes the command, with `run_stage` for running the jobs.
int run_building(const BuildingOptions& options, const RunStage& run_stage);

/// Adds the hidden command `building-step`, which the jobs call.
/// @param work  receives the call that executes the step; must outlive the parsing
void add_building_steps(CLI::App& app, std::function<int()>& work);

}  // namespace roomradar
