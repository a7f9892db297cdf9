// measuring_options.cpp: option names, help texts and checks of `roomradar fallthrough`, `trade` and `farm`.
#include "app/cli/options/measuring_options.hpp"

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <vector>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {
namespace {

void add_recorded_room_options(CLI::App& command, FallthroughOptions& options) {
  command.add_option("SOURCE", options.source,
                     "recording of the room of --map; its first frame is used (default: simulated rooms)");
  command.add_option("--map", options.map, "map of SOURCE's room (required with SOURCE)")->type_name("DIR");
  command
      .add_option("--reference", options.reference,
                  "map whose surface is the ground truth (default: the one of --map)")
      ->type_name("DIR");
  add_poses_option(
      command, options.poses,
      "localise the frame's camera in the map (auto, tracked), or use the recording's pose (recorded)");
  add_frames_option(command, options.frames);
  add_calibration_option(command, options.calibration);
  command
      .add_option("--cell", options.cell_m, with_default("edge of the grid's cells, metres", options.cell_m))
      ->check(within(0.01, 10.0, "metres"))
      ->type_name("M");
  command
      .add_option("--picture", options.picture,
                  "draw a plan of the surfaces that the balls rest on (default: not written)")
      ->type_name("FILE.png");
}

void add_radar_option(CLI::App& command, FallthroughOptions& options) {
  std::map<std::string, RadarMode> words;
  for (const RadarMode mode : kRadarModes) words.emplace(to_string(mode), mode);
  add_choice<RadarMode>(command, "--radar", options.radar, words, kRadarHelp);
}

void add_simulated_room_options(CLI::App& command, FallthroughOptions& options) {
  command
      .add_option("--scenarios", options.scenarios, with_default("number of scenarios", options.scenarios))
      ->check(whole_within(1, 1'000'000))
      ->type_name("N");
  command.add_option("--seed", options.seed, with_default("seed of the scenarios", options.seed))
      ->type_name("N");
  command
      .add_option("--random-rooms", options.random_rooms,
                  with_default("number of randomly furnished rooms, in addition to table, shelf and wall",
                               options.random_rooms))
      ->check(whole_within(0, 1000))
      ->type_name("N");
  command
      .add_option("--threads", options.threads,
                  "threads for scanning rooms and preparing scenarios (default: all processors)")
      ->check(whole_within(1, 256))
      ->type_name("N");
  command
      .add_option("--maps", options.maps,
                  "folder in which the rooms' maps are stored and reused (default: not stored)")
      ->type_name("DIR");
  command.add_option("--csv", options.csv, "write a line per scenario and policy (default: not written)")
      ->type_name("FILE");
  command
      .add_option("--html", options.html,
                  "write a page with tables, plots and pictures of failures (default: not written)")
      ->type_name("FILE");
  add_range_option(command, "--part", options.part,
                   "run only scenarios A to B, inclusive, counted from 0 (default: all)");
  command
      .add_option("--rows", options.rows,
                  "write the results of each scenario, as --jobs joins them (default: not written)")
      ->type_name("FILE");
  command
      .add_option(
          "--jobs", options.jobs,
          "split the run into jobs of `roomradar farm` in this folder, run those that are not done,\n"
          "and join their results: the same table, except for times, which are less accurate because\n"
          "jobs run side by side (default: this process runs all scenarios)")
      ->type_name("DIR");
  command
      .add_option("--job-size", options.job_size,
                  with_default("scenarios per job of --jobs", options.job_size))
      ->check(whole_within(1, 1'000'000))
      ->type_name("N");
  add_processes_option(command, options.processes);
  CLI::Option* scenario = command
                              .add_option("--scenario", options.scenario,
                                          "replay only this scenario, as a video (default: run all)")
                              ->check(whole_within(0, 1'000'000))
                              ->type_name("N");
  CLI::Option* video = command
                           .add_option("--video", options.video,
                                       "video of --scenario: .mp4, .avi or .mkv (required with --scenario)")
                           ->type_name("FILE");
  scenario->needs(video);
  video->needs(scenario);
}

}  // namespace

void add_options(CLI::App& command, FallthroughOptions& options) {
  add_recorded_room_options(command, options);
  add_simulated_room_options(command, options);
  add_radar_option(command, options);
  add_report_option(command, options.report);
}

void complete_options(const CLI::App& command, FallthroughOptions& options) {
  if (options.source.empty())
    refuse_given(command,
                 {"--map", "--reference", "--poses", "--frames", "--calibration", "--cell", "--picture"},
                 ": used only with a SOURCE, which is not given");
  else
    refuse_given(command,
                 {"--scenarios", "--seed", "--random-rooms", "--threads", "--maps", "--csv", "--html",
                  "--scenario", "--video", "--part", "--rows", "--jobs", "--job-size", "--processes"},
                 ": used only for simulated rooms, not with a SOURCE");
  if (!options.source.empty() && options.map.empty())
    throw CLI::ValidationError("--map is missing: map of SOURCE's room; `roomradar prescan` makes one");
  if (options.scenario)
    refuse_given(command,
                 {"--scenarios", "--threads", "--csv", "--html", "--report", "--part", "--rows", "--jobs",
                  "--job-size", "--processes"},
                 ": not available with --scenario");
  if (options.part) refuse_given(command, {"--scenarios", "--jobs"}, ": not available with --part");
  if (options.jobs.empty())
    refuse_given(command, {"--job-size", "--processes"}, ": used only with --jobs DIR, which is not given");
  else
    refuse_given(command, {"--maps", "--threads", "--rows"},
                 ": each job has its own; not available with --jobs");
}

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
      .add_option(
          "--settings", options.settings,
          with_default("number of settings per command, in addition to the default", options.settings))
      ->check(whole_within(1, 10'000))
      ->type_name("N");
  command
      .add_option("--repeats", options.repeats,
                  with_default("measurements per setting and scene", options.repeats))
      ->check(whole_within(1, 1000))
      ->type_name("N");
  command
      .add_option("--objects", options.objects,
                  with_default("virtual objects in a run, except in settings that change their number",
                               options.objects))
      ->check([](const std::string& text) {
        const bool is_one = text == "1" || text == "5" || text == "20";
        return is_one ? std::string() : "must be 1, 5 or 20, not " + text;
      })
      ->type_name("N");
  command
      .add_option("--seed", options.seed,
                  with_default("seed of the settings and of their order", options.seed))
      ->type_name("N");
  const std::map<std::string, std::string> times{{"wall", "wall"}, {"cpu", "cpu"}};
  add_choice(command, "--time", options.time, times,
             "compare settings by wall-clock time (wall) or, on a busy machine, by the CPU time of all\n"
             "threads (cpu)");
  command.add_flag(
      "--quick", options.quick,
      "use few frames of small images: a functional test, not a basis for choices (default: off)");
}

void add_result_options(CLI::App& command, TradeOptions& options) {
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

void add_options(CLI::App& command, FarmOptions& options) {
  command
      .add_option("MANIFEST", options.manifest,
                  "list of jobs, one per line: NAME: COMMAND ..., where {} is the job's own folder and\n"
                  "{NAME} that of a job which is done before (required)")
      ->required();
  command.add_option("--out", options.out, "folder of the results, with a folder per job (required)")
      ->required()
      ->type_name("DIR");
  add_processes_option(command, options.processes);
  command
      .add_option("--job", options.jobs,
                  "run only this job, after those that it needs; may be given several times. Needed jobs\n"
                  "that failed before are not run again, unless they are given, too (default: all jobs)")
      ->type_name("NAME");
  add_choice<std::optional<BatchForm>>(
      command, "--emit", options.emit,
      {{"make", BatchForm::kMake}, {"parallel", BatchForm::kParallel}, {"slurm", BatchForm::kSlurm}},
      "print a script that runs the jobs by make, GNU parallel or Slurm (default: run them here)");
  add_report_option(command, options.report);
}

}  // namespace roomradar
