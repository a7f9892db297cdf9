// command_line.hpp: parses the command line. A command is executed by the program that implements it.
#pragma once
#include <functional>

#include "app/cli/options/map_options.hpp"
#include "app/cli/options/measuring_options.hpp"
#include "app/cli/options/prescan_options.hpp"
#include "app/cli/options/recording_options.hpp"
#include "app/cli/options/run_options.hpp"

namespace CLI {
class App;
}

namespace roomradar {

/// Functions of the commands that a program implements. Each returns the exit status. A command whose
/// function is null is executed by the program that implements it, in the same folder.
struct Commands {
  // Implemented by `roomradar`.
  int (*without_arguments)(const char* first_steps) = nullptr;  ///< without a command; null: wrong usage
  int (*start)(const StartOptions& options) = nullptr;
  int (*prescan)(const PrescanOptions& options) = nullptr;
  int (*run)(const RunOptions& options) = nullptr;
  int (*map_info)(const MapInfoOptions& options) = nullptr;
  int (*map_verify)(const MapVerifyOptions& options) = nullptr;
  int (*map_export)(const MapExportOptions& options) = nullptr;
  int (*map_objects)(const MapObjectsOptions& options) = nullptr;
  int (*map_log)(const MapLogOptions& options) = nullptr;
  int (*map_restore)(const MapRestoreOptions& options) = nullptr;
  int (*map_undo)(const MapUndoOptions& options) = nullptr;
  int (*map_prune)(const MapPruneOptions& options) = nullptr;
  int (*map_list)(const MapListOptions& options) = nullptr;
  int (*map_copy)(const MapCopyOptions& options) = nullptr;
  int (*map_rename)(const MapRenameOptions& options) = nullptr;
  int (*map_delete)(const MapDeleteOptions& options) = nullptr;
  int (*map_pack)(const MapPackOptions& options) = nullptr;
  int (*map_unpack)(const MapUnpackOptions& options) = nullptr;
  int (*map_merge)(const MapMergeOptions& options) = nullptr;
  int (*map_diff)(const MapDiffOptions& options) = nullptr;
  int (*check)(const CheckOptions& options) = nullptr;
  int (*record)(const RecordOptions& options) = nullptr;
  int (*doctor)() = nullptr;
  int (*simulate)(const SimulateOptions& options) = nullptr;

  // Implemented by `roomradar-building`, also for `map` of a building.
  int (*building)(const BuildingOptions& options) = nullptr;
  /// Adds the hidden command `building-step`; see app/building/building_command.hpp.
  void (*add_building_steps)(CLI::App& app, std::function<int()>& work) = nullptr;
  int (*building_info)(const MapInfoOptions& options) = nullptr;
  int (*building_verify)(const MapVerifyOptions& options) = nullptr;
  int (*building_export)(const MapExportOptions& options) = nullptr;

  // Implemented by a program named after the command, such as `roomradar-farm`.
  int (*calibrate)(const CalibrateOptions& options) = nullptr;
  int (*fallthrough)(const FallthroughOptions& options) = nullptr;
  int (*farm)(const FarmOptions& options) = nullptr;
  int (*serve)(const ServeOptions& options) = nullptr;
  int (*trade)(const TradeOptions& options) = nullptr;
};

struct ParsedCommand {
  std::function<int()> work;  ///< the command; empty: help or a usage message was printed
  int exit_status = 0;        ///< if `work` is empty: 0 after help, 2 after wrong usage
};

/// Parses the arguments. Prints help or a usage message if needed. Throws Error if a presets file or a
/// recorded session named in the arguments cannot be read.
ParsedCommand parse_command_line(int argc, const char* const* argv, const Commands& here);

/// main() of a program with these commands: executes the command line and reports errors. Returns the exit
/// status.
int run_program(int argc, char** argv, const Commands& here);

}  // namespace roomradar
