// command_line.cpp: defines the commands: name, description, options, program.
#include "app/commands/command_line.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/completion.hpp"
#include "app/cli/help_topics.hpp"
#include "app/cli/manual_page.hpp"
#include "app/cli/options/command_tree.hpp"
#include "app/cli/options/option_checks.hpp"
#include "app/cli/program_beside.hpp"
#include "app/cli/session_folder.hpp"
#include "app/cli/usage_fault.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
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

constexpr const char* kRoomradar = "roomradar";
constexpr const char* kBuildingProgram = "roomradar-building";

/// Executes the command line with another program in this program's folder, which takes this one's place.
/// Throws Error if it is missing.
int hand_over(const std::string& program, const std::vector<std::string>& line) {
  const std::filesystem::path file = program_beside(program);
  std::vector<char*> words;
  for (const std::string& word : line) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  std::fflush(stdout);
  execv(file.c_str(), words.data());
  throw Error(file.string() + ": cannot be started: " + system_reason(errno));
}

/// The line to parse, and what was found.
struct Parsing {
  const Commands& here;
  std::vector<std::string> line;  ///< its words, the first is the program's name
  std::function<int()> work{};
};

/// Returns the work of a command that another program implements.
std::function<int()> handing_over(const std::string& program, const Parsing& parsing) {
  return [program, line = parsing.line] { return hand_over(program, line); };
}

/// Returns the work of a command.
/// @param program  the program that executes the command if `execute` is null
template <typename Options>
std::function<int()> work_of(const std::shared_ptr<Options>& options, int (*execute)(const Options&),
                             const std::string& program, const Parsing& parsing) {
  if (execute == nullptr) return handing_over(program, parsing);
  return [options, execute] { return execute(*options); };
}

/// Adds a command.
/// @param parsing  receives the work when the command was parsed; must outlive the parsing
/// @param program  the program that executes the command if `execute` is null
template <typename Options>
CLI::App* add_command(CLI::App& app, const char* name, const char* description, Parsing& parsing,
                      int (*execute)(const Options&), const std::string& program = kRoomradar) {
  CLI::App* command = app.add_subcommand(name, description);
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->callback([command, options, &parsing, execute, program] {
    if constexpr (requires { options->line; }) options->line = parsing.line;
    if constexpr (requires { complete_options(*command, *options); }) complete_options(*command, *options);
    parsing.work = work_of(options, execute, program, parsing);
  });
  return command;
}

/// Adds a `map` command that a building's map has, too.
template <typename Options>
void add_command_of_both(CLI::App& map, const char* name, const char* description, Parsing& parsing,
                         int (*execute)(const Options&), int (*execute_on_building)(const Options&)) {
  CLI::App* command = map.add_subcommand(name, description);
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->callback([options, &parsing, execute, execute_on_building] {
    parsing.work = [options, of_room = work_of(options, execute, kRoomradar, parsing),
                    of_building = work_of(options, execute_on_building, kBuildingProgram, parsing)] {
      return is_building(options->map) ? of_building() : of_room();
    };
  });
}

/// Adds the `map` commands that treat a map as a folder or file.
void add_housekeeping_commands(CLI::App& map, Parsing& parsing) {
  const Commands& here = parsing.here;
  add_command(map, "list", "list the maps in a folder; exit status 1 if one is damaged", parsing,
              here.map_list);
  add_command(map, "copy", "copy a map with all that is in its folder", parsing, here.map_copy);
  add_command(map, "rename", "give a map another name or place, also out of the trash", parsing,
              here.map_rename);
  add_command(map, "delete", "move a map to the trash, or delete it for good", parsing, here.map_delete);
  add_command(map, "pack", "write a map as one file, to send or to keep", parsing, here.map_pack);
  add_command(map, "unpack", "make a map from a file that `map pack` wrote; the file is checked first",
              parsing, here.map_unpack);
}

void add_map_commands(CLI::App& app, Parsing& parsing) {
  const Commands& here = parsing.here;
  CLI::App& map =
      *app.add_subcommand("map",
                          "describe, verify, export, merge or compare saved maps; the objects in them;\n"
                          "list, copy, rename, delete, pack or unpack maps");
  map.require_subcommand(1);
  add_command_of_both(map, "info", "describe a map", parsing, here.map_info, here.building_info);
  add_command_of_both(map, "verify", "check every file against its checksum; exit status 1 if one differs",
                      parsing, here.map_verify, here.building_verify);
  add_command_of_both(map, "export", "write the octree or the mesh for other programs", parsing,
                      here.map_export, here.building_export);
  add_command(map, "objects", "list, remove or rename the virtual objects that stay in a room", parsing,
              here.map_objects);
  add_command(map, "log", "list the revisions of a map: when, by which command, and what changed", parsing,
              here.map_log);
  add_command(map, "restore", "make an earlier revision of a map its present state", parsing,
              here.map_restore);
  add_command(map, "undo", "go back to the revision from which the map's present state was made", parsing,
              here.map_undo);
  add_command(map, "prune", "remove the oldest revisions of a map", parsing, here.map_prune);
  add_housekeeping_commands(map, parsing);
  add_command(
      map, "merge",
      "merge two overlapping maps of one room; B is registered to A by common views and by surfaces,\n"
      "and rejected if the registration is not reliable",
      parsing, here.map_merge);
  add_command(map, "diff",
              "list what appeared in B and what vanished since A, where both have data, in A's world",
              parsing, here.map_diff);
}

void add_building_commands(CLI::App& app, Parsing& parsing) {
  add_command(app, "building",
              "make one map of a building from many recordings, or bring it up to date:\n"
              "tracks each recording, finds those that show the same places, puts all into one world, and\n"
              "saves octree and surface in tiles, also as tileset.json with .glb for viewers of 3D Tiles",
              parsing, parsing.here.building, kBuildingProgram);
  if (parsing.here.add_building_steps != nullptr) {
    parsing.here.add_building_steps(app, parsing.work);
    return;
  }
  CLI::App& steps = *app.add_subcommand("building-step", "one job of `roomradar building`");
  steps.group("");
  steps.prefix_command();  // its program parses the rest
  steps.callback([&parsing] { parsing.work = handing_over(kBuildingProgram, parsing); });
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

void add_measuring_commands(CLI::App& app, Parsing& parsing) {
  const Commands& here = parsing.here;
  add_command(app, "simulate", "record a simulated Kinect, with ground truth", parsing, here.simulate)
      ->group(kMeasure);
  add_command(
      app, "fallthrough",
      "how often objects pass through hidden surfaces, per surface policy:\n"
      "drops and pushes objects behind occluders and compares with simulated ground truth. With a SOURCE:\n"
      "drops a ball over each cell of a grid in its map, with the surfaces of one frame",
      parsing, here.fallthrough, "roomradar-fallthrough")
      ->group(kMeasure);
  add_command(
      app, "farm",
      "run a list of commands as jobs:\n"
      "each job has its own folder, which is complete or absent. A job is skipped if its folder exists\n"
      "for the same program, command and inputs. A failed job is counted, and the others continue",
      parsing, here.farm, "roomradar-farm")
      ->group(kMeasure);
  add_command(app, "trade",
              "measure what accuracy costs on this machine, setting by setting:\n"
              "random settings of prescan and run, then greedy combinations of the best single changes, in\n"
              "simulated rooms with ground truth and in recordings; each setting is measured between two\n"
              "measurements of the default",
              parsing, here.trade, "roomradar-trade")
      ->group(kMeasure);
}

void add_commands(CLI::App& app, Parsing& parsing) {
  const Commands& here = parsing.here;
  add_command(app, "start",
              "choose sources and maps in a window, scan and play there; also: roomradar alone,\n"
              "or roomradar NAME with the name of a map or a recording",
              parsing, here.start);
  add_command(app, "prescan", "scan a room and save it as a map", parsing, here.prescan);
  add_command(app, "run", "run augmented reality in a saved map", parsing, here.run);
  add_map_commands(app, parsing);
  add_building_commands(app, parsing);
  add_command(
      app, "serve",
      "serve maps over HTTP until Ctrl-C:\n"
      "GET /maps, /maps/NAME, /maps/NAME/tileset.json and tiles; POST /maps/NAME/locate or /locate with a\n"
      "depth and a colour image answers with the camera's pose; `roomradar help http` has the formats",
      parsing, here.serve, "roomradar-serve");
  add_command(
      app, "check",
      "examine a recording in a few seconds: kind, times, unit, cameras, poses, and whether its depth\n"
      "agrees with them; exit status 1 if there is something to correct or to state",
      parsing, here.check);
  add_command(app, "record", "write a source's frames as a recording", parsing, here.record);
  add_command(app, "calibrate",
              "estimate a device's cameras, lenses and depth errors from a recorded checkerboard,\n"
              "held still in 20 or more places: near, far, tilted, in every part of the image;\n"
              "`roomradar help calibrate` goes through it step by step",
              parsing, here.calibrate, "roomradar-calibrate");
  app.add_subcommand(
         "doctor", "check this set-up and say how to repair it; exit status 1 if something must be repaired")
      ->callback([&parsing] {
        if (parsing.here.doctor != nullptr)
          parsing.work = parsing.here.doctor;
        else
          parsing.work = handing_over(kRoomradar, parsing);
      });
  add_help_command(app);
  add_measuring_commands(app, parsing);
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

ParsedCommand parse_command_line(int argc, const char* const* argv, const Commands& here) {
  Parsing parsing{here, {argv, argv + argc}};
  if (argc <= 1 && here.without_arguments != nullptr)
    return {[execute = here.without_arguments] { return execute(kAlone); }, 0};
  CLI::App app(
      "roomradar: prescan a room once with a Kinect, then run augmented reality in the saved map.\n"
      "Exit status: 0 done, 1 the work failed (stderr says what and what to do), 2 wrong usage.",
      "roomradar");
  app.set_version_flag("--version", kVersion);
  app.require_subcommand(1);
  add_commands(app, parsing);
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
  return {parsing.work, 0};
}

int run_program(int argc, char** argv, const Commands& here) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file size limit causes a write error instead of a kill
  try {
    const ParsedCommand command = parse_command_line(argc, argv, here);
    const int status = command.work ? command.work() : command.exit_status;
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout.flush())
      throw Error("stdout: the output could not be written completely; is the disk full?");
    return status;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "roomradar: memory ran out; close other programs, or use coarser cells or smaller images\n");
    return 1;
  } catch (const std::filesystem::filesystem_error& error) {
    std::fprintf(stderr, "roomradar: %s: cannot be used: %s\n", error.path1().c_str(),
                 system_reason(error.code()).c_str());
    return 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "roomradar: %s\n", error.what());
    return 1;
  }
}

}  // namespace roomradar
