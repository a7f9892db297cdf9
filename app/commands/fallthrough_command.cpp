// fallthrough_command.cpp: roomradar fallthrough: runs the same hidden-surface scenarios under each policy.
#include "app/commands/commands.hpp"

#include <unistd.h>

#include <cstdio>
#include <deque>
#include <filesystem>
#include <future>
#include <memory>
#include <vector>

#include "app/cli/deferred_errors.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report.hpp"
#include "app/commands/farm_command.hpp"
#include "app/commands/grid_command.hpp"
#include "app/evaluation/fallthrough/mapped_room.hpp"
#include "app/evaluation/fallthrough/page.hpp"
#include "app/evaluation/fallthrough/scenario_jobs.hpp"
#include "app/evaluation/fallthrough/totals.hpp"
#include "app/evaluation/fallthrough/trial.hpp"
#include "app/evaluation/fallthrough/trial_pictures.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/parallel_for.hpp"
#include "radar/batch/passes_radar.hpp"

namespace roomradar {
namespace {

using Rooms = std::vector<std::unique_ptr<MappedRoom>>;

/// Creates the folder for the rooms' maps; an empty name is allowed. Throws Error if it cannot be created, or
/// if it is empty and not writable.
void require_folder_of_maps(const std::filesystem::path& folder) {
  if (folder.empty()) return;
  require_contents_outside_maps(folder);
  make_folder(folder);
  std::error_code fault;
  if (access(folder.c_str(), W_OK) != 0 && is_empty_folder(folder, fault))
    throw Error(folder.string() + ": no map can be stored there: the folder is not writable");
}

struct ScenarioNumbers {
  std::int64_t begin = 0, end = 0;
};
ScenarioNumbers numbers_of(const FallthroughOptions& options) {
  return options.part ? ScenarioNumbers{options.part->first, options.part->last + 1}
                      : ScenarioNumbers{0, options.scenarios};
}

/// Runs the scenarios under all policies, with `threads` scenarios prepared ahead. Ends at the first error,
/// with the rows so far.
std::vector<ScenarioRow> run_scenarios(const Rooms& rooms, Radar& radar, const FallthroughOptions& options,
                                       int threads, DeferredErrors& faults) {
  std::deque<std::future<std::unique_ptr<PreparedScenario>>> ahead;
  std::int64_t next = numbers_of(options).begin;
  const auto prepare_next = [&] {
    const ScenarioTurn turn = turn_of(next++, rooms.size());
    const ScenarioRoom& room = rooms[turn.room]->scanned.simulated;
    ahead.push_back(std::async(std::launch::async, [&room, seed = options.seed, number = turn.number] {
      return std::make_unique<PreparedScenario>(room, seed, number);
    }));
  };
  const ScenarioNumbers numbers = numbers_of(options);
  Progress progress("scenarios", numbers.end - numbers.begin);
  std::vector<ScenarioRow> rows;
  const auto run_scenario = [&](std::int64_t number) {
    while (next < numbers.end && ahead.size() < static_cast<std::size_t>(threads)) prepare_next();
    const std::unique_ptr<PreparedScenario> prepared = ahead.front().get();
    ahead.pop_front();
    const std::size_t room_number = turn_of(number, rooms.size()).room;
    MappedRoom& room = *rooms[room_number];
    ScenarioRow row = row_of(prepared->scenario, number, room_number, room.scanned.title);
    // All policies see the frame before any is timed, and each is first in turn.
    for (std::size_t i = 0; i < kPolicyCount; ++i)
      (void)show_frame(*prepared, 0, {.policy = kFallthroughPolicies[i].surfaces}, {}, *room.scenes[i]);
    for (std::size_t k = 0; k < kPolicyCount; ++k) {
      const std::size_t i = (static_cast<std::size_t>(number) + k) % kPolicyCount;
      row.trials[i] = run_trial(*prepared, room, i, radar);
    }
    rows.push_back(std::move(row));
    progress.step(room.scanned.title);
  };
  faults.attempt([&] {
    for (std::int64_t number = numbers.begin; number < numbers.end; ++number) run_scenario(number);
  });
  return rows;
}

/// Draws a limited number of each policy's failures, last policies first.
std::vector<FailurePicture> picture_failures(const Rooms& rooms, Radar& radar,
                                             const std::vector<ScenarioRow>& rows, std::uint64_t seed) {
  constexpr std::size_t kMostOfMaps = 24, kMostOfOthers = 4;
  std::vector<FailurePicture> pictures;
  for (std::size_t i = kPolicyCount; i-- > 0;) {
    const bool is_map = kFallthroughPolicies[i].surfaces == SurfacePolicy::kMap;
    std::size_t left = is_map ? kMostOfMaps : kMostOfOthers;
    for (const ScenarioRow& row : rows) {
      const Verdict& verdict = row.trials[i].verdict;
      if (verdict.outcome == Outcome::kStoppedRight) continue;
      if (left-- == 0) break;
      MappedRoom& room = *rooms[row.room];
      PreparedScenario prepared(room.scanned.simulated, seed, turn_of(row.number, rooms.size()).number);
      char number[80];
      format_classic(number, sizeof number, "%+.1f cm; scenario %lld, ", 100.0 * verdict.error_m,
                     static_cast<long long>(row.number));
      pictures.push_back({std::string(kFallthroughPolicies[i].name) + ": " +
                              std::string(to_string(verdict.outcome)) + ", " + number + row.room_title +
                              ", " + std::string(to_string(row.shape)) + " behind " +
                              std::string(to_string(row.occluder)) +
                              ", rested on: " + std::string(to_string(row.trials[i].rested_on)),
                          picture_of_trial(prepared, room, i, radar)});
    }
  }
  return pictures;
}

/// Replays one scenario as a video; scans only its room.
int replay(const FallthroughOptions& options, const RoomScan& scan) {
  require_writable(options.video);
  VideoWriter video(options.video, kReplayPicturesPerS);
  const std::vector<RoomChoice> choices = choose_rooms(options.random_rooms);
  const ScenarioTurn turn = turn_of(*options.scenario, choices.size());
  const std::vector<RoomChoice> one{choices[turn.room]};
  GlContext context;
  const Rooms rooms = map_rooms(context, one, scan, 1);
  PreparedScenario prepared(rooms.front()->scanned.simulated, options.seed, turn.number);
  const std::unique_ptr<Radar> radar = make_radar({.mode = options.radar}, context);
  write_replay(prepared, *rooms.front(), *radar, video);
  for (std::size_t i = 0; i < kPolicyCount; ++i) {
    const Trial trial = run_trial(prepared, *rooms.front(), i, *radar);
    std::printf("%-11s %-10s %+7.1f mm, rested on: %s\n", std::string(kFallthroughPolicies[i].name).c_str(),
                std::string(to_string(trial.verdict.outcome)).c_str(), 1e3 * trial.verdict.error_m,
                std::string(to_string(trial.rested_on)).c_str());
  }
  return 0;
}

/// The rooms of a run, on the GPU, and the radar of its drops and pictures.
struct RoomsInUse {
  GlContext context;
  Rooms rooms;
  std::unique_ptr<Radar> radar;
};
std::unique_ptr<RoomsInUse> rooms_of(const FallthroughOptions& options, const RoomScan& scan, int threads) {
  auto in_use = std::make_unique<RoomsInUse>();
  in_use->rooms = map_rooms(in_use->context, choose_rooms(options.random_rooms), scan, threads);
  in_use->radar = make_radar({.mode = options.radar}, in_use->context);
  return in_use;
}

/// Prints and writes the results. Results that cannot be written do not keep others from being written.
void publish(const FallthroughOptions& options, const std::vector<ScenarioRow>& rows, RoomsInUse& in_use,
             Report& report, DeferredErrors& faults) {
  const ScenarioNumbers numbers = numbers_of(options);
  const int done = static_cast<int>(rows.size());
  const auto totals = totals_of(rows);
  const std::string about =
      std::to_string(done) +
      (done < numbers.end - numbers.begin ? " of " + std::to_string(numbers.end - numbers.begin) : "") +
      " scenarios, seed " + std::to_string(options.seed) + ", " + std::to_string(in_use.rooms.size()) +
      " rooms, " + in_use.context.renderer() +
      (options.jobs.empty() ? "" : "; frame times of jobs that ran beside others: not to be compared");
  std::printf("%s\n%s", about.c_str(), table_of(totals, done).c_str());
  report.renderer = in_use.context.renderer();
  report.results["scenarios"] = done;
  report.results["policies"] = to_json(totals);
  report.results["failures"] = failures_of(rows);
  if (!faults.first().empty()) report.results["fault"] = faults.first();
  faults.attempt([&] {
    if (!options.rows.empty()) write_rows(rows, options.rows);
  });
  faults.attempt([&] { write_csv(rows, options.csv); });
  faults.attempt([&] {
    if (options.html.empty()) return;
    write_page(rows, about, picture_failures(in_use.rooms, *in_use.radar, rows, options.seed), options.html);
  });
  faults.attempt([&] { write_report(report, options.report); });
  faults.throw_first();
}

/// Lets jobs run the scenarios, and publishes their results. Returns the exit status: 1 if a job failed.
int run_jobs(const FallthroughOptions& options, Report& report) {
  const JobFaults failed = report.times.timed("jobs", [&] {
    return run_split(options.jobs, scenario_manifest(options), "roomradar-fallthrough", {},
                     options.processes);
  });
  const std::vector<ScenarioRow> rows = joined_rows(options, failed);
  if (rows.empty()) throw Error(options.jobs + ": no job has results; the messages above say why");
  RoomScan scan;
  scan.maps = maps_of_jobs(options.jobs).string();
  const auto in_use = rooms_of(options, scan, 1);
  report.results["failed_jobs"] = failed;
  DeferredErrors faults;
  publish(options, rows, *in_use, report, faults);
  return failed.empty() ? 0 : 1;
}

}  // namespace

int run(const FallthroughOptions& options) {
  if (!options.source.empty()) return run_grid(options);
  RoomScan scan;
  scan.maps = options.maps;
  for (const std::string& path : {options.report, options.csv, options.html, options.rows})
    require_writable(path);
  require_folder_of_maps(options.maps);
  if (options.scenario) return replay(options, scan);
  const int threads = given_or_processors(options.threads);
  Report report;
  report.command = "fallthrough";
  report.source = "simulated rooms";
  report.settings = {{"scenarios", options.scenarios},
                     {"seed", options.seed},
                     {"random_rooms", options.random_rooms},
                     {"resolution_m", scan.resolution_m},
                     {"maps", options.maps},
                     {"threads", threads},
                     {"radar", std::string(to_string(options.radar))}};
  if (!options.jobs.empty()) return run_jobs(options, report);

  const auto in_use = report.times.timed("prescan", [&] { return rooms_of(options, scan, threads); });
  DeferredErrors faults;  // earlier results are written all the same
  const std::vector<ScenarioRow> rows = report.times.timed(
      "scenarios", [&] { return run_scenarios(in_use->rooms, *in_use->radar, options, threads, faults); });
  if (rows.empty()) faults.throw_first();
  publish(options, rows, *in_use, report, faults);
  return 0;
}

}  // namespace roomradar
