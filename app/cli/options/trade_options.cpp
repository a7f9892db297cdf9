// trade_options.cpp: option names, help texts and checks of `roomradar trade`.
#include "app/cli/options/trade_options.hpp"

#include <CLI/CLI.hpp>
#include <map>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/renamed_options.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {
namespace {

void add_sweep_options(CLI::App& command, TradeOptions& options) {
  command.add_option(
      "SOURCE", options.recordings,
      "folders with recordings that have poses, in addition to the simulated rooms (default: none)");
  command
      .add_option("--rooms", options.rooms,
                  "simulated rooms, separated by commas (default: table,random?seed=2)")
      ->allow_extra_args(false)  // the next argument is a recording
      ->delimiter(',')
      ->type_name("LIST");
  const std::map<std::string, std::string> commands{{"prescan", "prescan"}, {"run", "run"}};
  add_choice(command, "--only", options.only, commands, "measure only this command (default: both)");
  command
      .add_option("--settings", options.settings,
                  "number of settings per command, in addition to the default (default: 30)")
      ->check(whole_within(1, 10'000))
      ->type_name("N");
  command.add_option("--repeats", options.repeats, "measurements per setting and scene (default: 2)")
      ->check(whole_within(1, 1000))
      ->type_name("N");
  command
      .add_option("--objects", options.objects,
                  "virtual objects in a run, except in settings that change their number (default: 1)")
      ->check([](const std::string& text) {
        const bool is_one = text == "1" || text == "5" || text == "20";
        return is_one ? std::string() : "must be 1, 5 or 20, not " + text;
      })
      ->type_name("N");
  command.add_option("--seed", options.seed, "seed of the settings and of their order (default: 1)")
      ->type_name("N");
  const std::map<std::string, std::string> times{{"wall", "wall"}, {"cpu", "cpu"}};
  add_choice(command, "--time", options.time, times,
             "compare settings by wall-clock time (wall) or, on a busy machine, by the CPU time of all\n"
             "threads (cpu) (default: wall)");
  command.add_flag(
      "--quick", options.quick,
      "use few frames of small images: a functional test, not a basis for choices (default: off)");
}

void add_result_options(CLI::App& command, TradeOptions& options) {
  add_old_flag(command, "--table1", "--compare-published");
  command.add_flag("--compare-published", options.compare_published,
                   "only compare the published radar's three rows with this machine (default: off)");
  command
      .add_option("--csv", options.csv,
                  "write a line per measurement as it is made, and a line per setting at the end\n"
                  "(default: not written)")
      ->type_name("FILE");
  command
      .add_option("--html", options.html,
                  "write a page with plots of the fronts, and tables (default: not written)")
      ->type_name("FILE");
  command
      .add_option("--presets", options.presets,
                  "write fast, balanced, accurate and the front, for --preset and --budget-ms\n"
                  "(default: not written)")
      ->type_name("FILE");
  add_report_option(command, options.report);
}

}  // namespace

void add_options(CLI::App& command, TradeOptions& options) {
  add_sweep_options(command, options);
  add_result_options(command, options);
}

void complete_options(const CLI::App& command, TradeOptions& options) {
  if (command.count("--presets") > 0 && command.count("--only") > 0)
    throw CLI::ValidationError("--presets: need measurements of both prescan and run; leave out --only");
  if (command.count("--objects") > 0 && options.only == "prescan")
    throw CLI::ValidationError("--objects: used only for run, which --only leaves out");
  if (!options.compare_published) return;
  if ((command.count("--rooms") > 0 && options.rooms.size() > 1) || !options.recordings.empty())
    throw CLI::ValidationError("--compare-published: needs exactly one simulated room; give it with --rooms");
  for (const char* name :
       {"--only", "--settings", "--repeats", "--objects", "--seed", "--time", "--csv", "--html", "--presets"})
    if (command.count(name) > 0)
      throw CLI::ValidationError(std::string(name) + ": used only for a sweep, not with --compare-published");
}

}  // namespace roomradar
