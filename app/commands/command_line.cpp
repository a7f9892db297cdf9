// command_line.cpp: defines the commands: name, description, options, function.
#include "app/commands/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/building/building_command.hpp"
#include "app/cli/completion.hpp"
#include "app/cli/help_topics.hpp"
#include "app/cli/manual_page.hpp"
#include "app/cli/options/command_tree.hpp"
#include "app/cli/options/option_checks.hpp"
#include "app/cli/session_folder.hpp"
#include "app/cli/usage_fault.hpp"
#include "app/commands/commands.hpp"
#include "app/serve/serve_command.hpp"
#include "mapping/types/system/version.hpp"

namespace roomradar {
namespace {

constexpr const char* kAlone =
    "roomradar: scan a room once with a depth camera, then run augmented reality in the saved map.\n"
    "Alone, on a terminal with a display, it opens a window in which to choose. Otherwise begin with\n"
    "  roomradar doctor                                    # what of the set-up works\n"
    "  roomradar prescan kinect:0 --map maps/kitchen       # or a recording, or 'sim:table'\n"
    "  roomradar run kinect:0 --map maps/kitchen --window\n"
    "roomradar --help lists all commands\n";
constexpr const char* kMeasure = "Measuring and testing";
constexpr const char* kFirstSteps =
    "  roomradar doctor                                    # what of the set-up works\n"
    "  roomradar prescan kinect:0 --map maps/kitchen       # or a recording, or 'sim:table'\n"
    "  roomradar run kinect:0 --map maps/kitchen --window\n"
    "`roomradar COMMAND --help` explains a command, `roomradar help TOPIC` a topic: script, models,\n"
    "sources, units, calibrate, http, files. `source <(roomradar --completion bash)` completes commands and\n"
    "options in this shell (zsh: --completion zsh).\n";

/// Completes the options of `roomradar run`, which may come from a recorded session.
void complete_options(const CLI::App& command, RunOptions& options) {
  complete_options(command, options, [](const std::string& source) -> std::optional<RunOptions> {
    if (!is_session_folder(source)) return std::nullopt;
    return read_session(source);
  });
}

/// Returns the help of a command or a topic. Throws CLI::ValidationError naming the nearest known word.
std::string help_on(CLI::App& app, const std::vector<std::string>& words) {
  if (words.empty())  // app.help() is that of the command that was given, which is `help`
    return app.get_formatter()->make_help(&app, app.get_name(), CLI::AppFormatMode::Normal);
  for (const HelpTopic& topic : help_topics())
    if (words.size() == 1 && words.front() == topic.name) return std::string(topic.text);
  CLI::App* command = &app;
  std::string parents;  // the help adds the command's own name
  for (const std::string& word : words) {
    std::vector<std::string> known;
    for (const CLI::App* part : commands_of(*command)) known.push_back(part->get_name());
    if (command == &app)
      for (const HelpTopic& topic : help_topics())
        if (std::find(known.begin(), known.end(), topic.name) == known.end()) known.emplace_back(topic.name);
    CLI::App* part = command_named(*command, word);
    if (part == nullptr) {
      std::string hint = did_you_mean(word, known);
      if (hint.empty())
        for (const std::string& name : known) hint += (hint.empty() ? "; known are " : ", ") + name;
      throw CLI::ValidationError("there is no command or topic '" + word + "'" + hint);
    }
    parents += (parents.empty() ? "" : " ") + command->get_name();
    command = part;
  }
  return command->help(parents);
}

/// Adds the command that run(Options) executes.
/// @param work  receives that call when the command was parsed; must outlive the parsing
/// @param line  the words of the command line, for options that have a member `line`; null: not given
template <typename Options>
CLI::App* add_command(CLI::App& app, const char* name, const char* description, std::function<int()>& work,
                      const std::vector<std::string>* line = nullptr) {
  CLI::App* command = app.add_subcommand(name, description);
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->callback([command, options, &work, line] {
    if constexpr (requires { options->line; })
      if (line != nullptr) options->line = *line;
    if constexpr (requires { complete_options(*command, *options); }) complete_options(*command, *options);
    work = [options] { return run(*options); };
  });
  return command;
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

/// Adds `help [COMMAND | TOPIC]`.
void add_help_command(CLI::App& app) {
  CLI::App& help = *app.add_subcommand(
      "help", "explain a command, or a topic: script, models, sources, units, calibrate, http, files");
  const auto words = std::make_shared<std::vector<std::string>>();
  help.add_option("WORD", *words, "command or topic (default: the list of commands)");
  help.callback([&app, words] {
    std::fputs(help_on(app, *words).c_str(), stdout);
    throw CLI::Success();
  });
}

void add_measuring_commands(CLI::App& app, std::function<int()>& work) {
  add_command<SimulateOptions>(app, "simulate", "record a simulated Kinect, with ground truth", work)
      ->group(kMeasure);
  add_command<FallthroughOptions>(
      app, "fallthrough",
      "how often objects pass through hidden surfaces, per surface policy:\n"
      "drops and pushes objects behind occluders and compares with simulated ground truth. With a SOURCE:\n"
      "drops a ball over each cell of a grid in its map, with the surfaces of one frame",
      work)
      ->group(kMeasure);
  add_command<FarmOptions>(
      app, "farm",
      "run a list of commands as jobs:\n"
      "each job has its own folder, which is complete or absent. A job is skipped if its folder exists\n"
      "for the same program, command and inputs. A failed job is counted, and the others continue",
      work)
      ->group(kMeasure);
  add_command<TradeOptions>(
      app, "trade",
      "measure what accuracy costs on this machine, setting by setting:\n"
      "random settings of prescan and run, then greedy combinations of the best single changes, in\n"
      "simulated rooms with ground truth and in recordings; each setting is measured between two\n"
      "measurements of the default",
      work)
      ->group(kMeasure);
}

void add_commands(CLI::App& app, std::function<int()>& work, const std::vector<std::string>& line) {
  add_command<StartOptions>(
      app, "start",
      "choose sources and maps in a window, scan and play there; also: roomradar alone,\n"
      "or roomradar NAME with the name of a map or a recording",
      work);
  add_command<PrescanOptions>(app, "prescan", "scan a room and save it as a map", work, &line);
  add_command<RunOptions>(app, "run", "run augmented reality in a saved map", work);
  add_map_commands(app, work);
  add_command<BuildingOptions>(
      app, "building",
      "make one map of a building from many recordings, or bring it up to date:\n"
      "tracks each recording, finds those that show the same places, puts all into one world, and\n"
      "saves octree and surface in tiles, also as tileset.json with .glb for viewers of 3D Tiles",
      work);
  add_building_steps(app, work);
  add_command<ServeOptions>(
      app, "serve",
      "serve maps over HTTP until Ctrl-C:\n"
      "GET /maps, /maps/NAME, /maps/NAME/tileset.json and tiles; POST /maps/NAME/locate or /locate with a\n"
      "depth and a colour image answers with the camera's pose; `roomradar help http` has the formats",
      work);
  add_command<CheckOptions>(
      app, "check",
      "examine a recording in a few seconds: kind, times, unit, cameras, poses, and whether its depth\n"
      "agrees with them; exit status 1 if there is something to correct or to state",
      work);
  add_command<RecordOptions>(app, "record", "write a source's frames as a recording", work);
  add_command<CalibrateOptions>(
      app, "calibrate",
      "estimate a device's cameras, lenses and depth errors from a recorded checkerboard,\n"
      "held still in 20 or more places: near, far, tilted, in every part of the image;\n"
      "`roomradar help calibrate` goes through it step by step",
      work);
  app.add_subcommand(
         "doctor", "check this set-up and say how to repair it; exit status 1 if something must be repaired")
      ->callback([&work] { work = run_doctor; });
  add_help_command(app);
  add_measuring_commands(app, work);
  for (CLI::App* command : commands_of(app))
    if (command->get_group() != kMeasure) command->group("Commands");
}

/// Returns true if the command line begins with a file or folder in place of a command.
bool begins_with_file(CLI::App& app, int argc, const char* const* argv) {
  if (argc < 2 || argv[1][0] == '-' || command_named(app, argv[1]) != nullptr) return false;
  std::error_code ignored;
  return std::filesystem::exists(argv[1], ignored);
}

}  // namespace

ParsedCommand parse_command_line(int argc, const char* const* argv) {
  if (argc <= 1) return {[] { return run_start_alone(kAlone); }, 0};
  std::function<int()> work;
  CLI::App app(
      "roomradar: prescan a room once with a Kinect, then run augmented reality in the saved map.\n"
      "Exit status: 0 done, 1 the work failed (stderr says what and what to do), 2 wrong usage.",
      "roomradar");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  const std::vector<std::string> line(argv, argv + argc);
  add_commands(app, work, line);
  app.add_flag_callback("--manual",
                        [&app] {
                          std::fputs(manual_page(app).c_str(), stdout);
                          throw CLI::Success();
                        })
      ->group("");
  app.add_option_function<std::string>("--completion",
                                       [&app](const std::string& shell) {
                                         std::fputs(completion_script(app, shell).c_str(), stdout);
                                         throw CLI::Success();
                                       })
      ->group("");
  app.footer(kFirstSteps);
  arrange_help(app);
  refuse_other_bases(app);
  refuse_flag_values(app);
  std::vector<const char*> words(argv, argv + argc);
  if (begins_with_file(app, argc, argv)) words.insert(words.begin() + 1, "start");
  try {
    app.parse(static_cast<int>(words.size()), words.data());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return {{}, app.exit(error)};
    const std::vector<std::string> arguments(argv + 1, argv + std::max(argc, 1));
    std::fputs(usage_fault(app, error, arguments).c_str(), stderr);
    return {{}, 2};
  }
  return {work, 0};
}

}  // namespace roomradar
