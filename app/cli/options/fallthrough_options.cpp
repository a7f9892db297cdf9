// fallthrough_options.cpp: option names, help texts and checks of `roomradar fallthrough`.
#include "app/cli/options/fallthrough_options.hpp"

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
      "localise the frame's camera in the map (auto, tracked), or use the recording's pose (recorded)\n"
      "(default: auto)");
  add_frames_option(command, options.frames);
  add_calibration_option(command, options.calibration);
  command.add_option("--cell", options.cell_m, "edge of the grid's cells, metres (default: 0.1)")
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
  add_choice<RadarMode>(
      command, "--radar", options.radar, words,
      "distance to contact: exact; between bounds about a pixel apart (sampled); or, between such\n"
      "bounds, from Cyber Radar's two rendered depth passes (passes) (default: exact)");
}

void add_simulated_room_options(CLI::App& command, FallthroughOptions& options) {
  command.add_option("--scenarios", options.scenarios, "number of scenarios (default: 200)")
      ->check(whole_within(1, 1'000'000))
      ->type_name("N");
  command.add_option("--seed", options.seed, "seed of the scenarios (default: 1)")->type_name("N");
  command
      .add_option("--random-rooms", options.random_rooms,
                  "number of randomly furnished rooms, in addition to table, shelf and wall (default: 3)")
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
  command.add_option("--job-size", options.job_size, "scenarios per job of --jobs (default: 100)")
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

}  // namespace roomradar
