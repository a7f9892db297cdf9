// building_command.hpp: execution of `roomradar building` and of its jobs.
#pragma once
#include <functional>

#include "app/building/building.hpp"
#include "app/cli/options/map_options.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// Executes the command on this machine's processors. Returns the exit status.
int run(const BuildingOptions& options);
/// Executes the command, with `run_stage` for running the jobs.
int run_building(const BuildingOptions& options, const RunStage& run_stage);

/// Adds the hidden command `building-step`, which the jobs call.
/// @param work  receives the call that executes the step; must outlive the parsing
void add_building_steps(CLI::App& app, std::function<int()>& work);

}  // namespace roomradar
