// trade_options.cpp: option names, help texts and checks of `roomradar trade`.
#include "app/cli/options/trade_options.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

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
                  "simulated rooms, separated by commas; none: only SOURCE (default: table,random?seed=2)")
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

void add_job_options(CLI::App& command, TradeOptions& options) {
  command
      .add_option("--jobs", options.jobs,
                  "split the sweep into jobs of `roomradar farm` in this folder, one per setting and scene,\n"
                  "run those that are not done, and join their results: the same errors, but times that are\n"
                  "not to be compared, as jobs run beside others (default: this process measures)")
      ->type_name("DIR");
  add_processes_option(command, options.processes);
  command
      .add_option("--setting", options.setting,
                  "measure only this setting, as a job of --jobs does: default, or NAME=VALUE,NAME=VALUE...\n"
                  "(default: a sweep)")
      ->type_name("LIST");
  command
      .add_option("--rows", options.rows,
                  "write the measurements of --setting, as --jobs joins them (required with --setting)")
      ->type_name("FILE");
}

}  // namespace

void add_options(CLI::App& command, TradeOptions& options) {
  add_sweep_options(command, options);
  add_result_options(command, options);
  add_job_options(command, options);
}

void complete_options(const CLI::App& command, TradeOptions& options) {
  if (options.rooms == std::vector<std::string>{"none"}) options.rooms.clear();
  if (options.rooms.empty() && options.recordings.empty())
    throw CLI::ValidationError("--rooms none: leaves nothing to measure in; give a SOURCE");
  if (options.jobs.empty())
    refuse_given(command, {"--processes"}, ": used only with --jobs DIR, which is not given");
  else
    refuse_given(command, {"--presets"},
                 ": are chosen by times, which are less accurate if jobs run side by side; leave out --jobs");
  if ((command.count("--setting") > 0) != (command.count("--rows") > 0))
    throw CLI::ValidationError("--setting and --rows are used only together");
  if (command.count("--setting") > 0) {
    if (options.setting.empty()) throw CLI::ValidationError("--setting: is empty; the default is: default");
    if (command.count("--only") == 0) throw CLI::RequiredError("--only, with --setting,");
    refuse_given(command,
                 {"--settings", "--seed", "--time", "--csv", "--html", "--presets", "--report", "--jobs",
                  "--compare-published"},
                 ": used only for a sweep, not with --setting");
  }
  if (command.count("--presets") > 0 && command.count("--only") > 0)
    throw CLI::ValidationError("--presets: need measurements of both prescan and run; leave out --only");
  if (command.count("--objects") > 0 && options.only == "prescan")
    throw CLI::ValidationError("--objects: used only for run, which --only leaves out");
  if (!options.compare_published) return;
  if ((command.count("--rooms") > 0 && options.rooms.size() > 1) || !options.recordings.empty())
    throw CLI::ValidationError("--compare-published: needs exactly one simulated room; give it with --rooms");
  refuse_given(command,
               {"--only", "--settings", "--repeats", "--objects", "--seed", "--time", "--csv", "--html",
                "--presets", "--jobs"},
               ": used only for a sweep, not with --compare-published");
}

}  // namespace roomradar
