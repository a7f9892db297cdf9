// command_line.cpp: joins the commands: name, description, options, function.
#include "app/commands/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "app/cli/manual_page.hpp"
#include "app/cli/options/option_checks.hpp"
#include "app/cli/session_folder.hpp"
#include "app/commands/calibrate_command.hpp"
#include "app/commands/doctor_command.hpp"
#include "app/commands/fallthrough_command.hpp"
#include "app/commands/map_command.hpp"
#include "app/commands/map_pair_commands.hpp"
#include "app/commands/prescan_command.hpp"
#include "app/commands/record_command.hpp"
#include "app/commands/run_command.hpp"
#include "app/commands/simulate_command.hpp"
#include "app/commands/trade_command.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

/// Completes the options of `roomradar run`, which may come from a recorded session.
void complete_options(const CLI::App& command, RunOptions& options) {
  complete_options(command, options, [](const std::string& source) -> std::optional<RunOptions> {
    if (!is_session_folder(source)) return std::nullopt;
    return read_session(source);
  });
}

/// Adds the command that run(Options) executes.
/// @param work  receives that call when the command was parsed; must outlive the parsing
template <typename Options>
void add_command(CLI::App& app, const char* name, const char* description, std::function<int()>& work) {
  CLI::App* command = app.add_subcommand(name, description);
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->callback([command, options, &work] {
    if constexpr (requires { complete_options(*command, *options); }) complete_options(*command, *options);
    work = [options] { return run(*options); };
  });
}

void add_map_commands(CLI::App& app, std::function<int()>& work) {
  CLI::App& map = *app.add_subcommand("map", "describe, verify, export, merge or compare saved maps");
  map.require_subcommand(1);
  add_command<MapInfoOptions>(map, "info", "describe a map", work);
  add_command<MapVerifyOptions>(map, "verify",
                                "check every file against its checksum; exit status 1 if one differs", work);
  add_command<MapExportOptions>(map, "export", "write the octree or the mesh for other programs", work);
  add_command<MapMergeOptions>(
      map, "merge",
      "merge two overlapping maps of one room; B is registered to A by common views and by surfaces,\n"
      "and rejected if the registration is not reliable",
      work);
  add_command<MapDiffOptions>(
      map, "diff", "list what appeared in B and what vanished since A, where both have data, in A's world",
      work);
}

void add_evaluation_commands(CLI::App& app, std::function<int()>& work) {
  add_command<FallthroughOptions>(
      app, "fallthrough",
      "drop and push objects behind occluders under each surface policy, and compare with simulated\n"
      "ground truth. With a SOURCE: drop a ball over each cell of a grid in its map, with the\n"
      "surfaces of one frame",
      work);
  add_command<TradeOptions>(
      app, "trade",
      "measure time against accuracy: random settings of prescan and run, then greedy combinations of\n"
      "the best single changes, in simulated rooms with ground truth and in recordings; each setting is\n"
      "measured between two measurements of the default",
      work);
}

void add_commands(CLI::App& app, std::function<int()>& work) {
  add_command<PrescanOptions>(app, "prescan", "scan a room and save it as a map", work);
  add_command<RunOptions>(app, "run", "run augmented reality in a saved map", work);
  add_map_commands(app, work);
  add_command<RecordOptions>(app, "record", "write a source's frames as a recording", work);
  add_command<CalibrateOptions>(
      app, "calibrate",
      "estimate both cameras, their lenses, their relative pose and the depth's errors from a\n"
      "recording of a checkerboard that is held still in 20 or more places: near, far, tilted, in\n"
      "every part of the image",
      work);
  app.add_subcommand(
         "doctor", "check this set-up and say how to repair it; exit status 1 if something must be repaired")
      ->callback([&work] { work = run_doctor; });
  add_command<SimulateOptions>(app, "simulate", "record a simulated Kinect, with ground truth", work);
  add_evaluation_commands(app, work);
}

}  // namespace

ParsedCommand parse_command_line(int argc, const char* const* argv) {
  std::function<int()> work;
  CLI::App app(
      "roomradar: prescan a room once with a Kinect, then run augmented reality in the saved map.\n"
      "Exit status: 0 done, 1 the work failed (stderr says what and what to do), 2 wrong usage.",
      "roomradar");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  app.get_formatter()->column_width(32);  // before the commands, which copy it
  add_commands(app, work);
  app.add_flag_callback("--manual",
                        [&app] {
                          std::fputs(manual_page(app).c_str(), stdout);
                          throw CLI::Success();
                        })
      ->group("");
  refuse_other_bases(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool is_help = app.exit(error) == 0;
    return {{}, is_help ? 0 : 2};
  }
  return {work, 0};
}

}  // namespace roomradar
