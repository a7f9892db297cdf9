// fallthrough_command.cpp: roomradar fallthrough: the same hidden-surface scenarios under each policy.
#include <algorithm>
#include <cstdio>
#include <deque>
#include <future>
#include <memory>
#include <thread>

#include "app/commands.hpp"
#include "app/fallthrough/mapped_room.hpp"
#include "app/fallthrough/totals.hpp"
#include "app/fallthrough/trial.hpp"
#include "app/progress.hpp"
#include "app/report.hpp"

namespace roomradar {
namespace {

using Rooms = std::vector<std::unique_ptr<MappedRoom>>;

/// Scenario after scenario under all policies; `threads` of them are made ready ahead.
std::vector<ScenarioRow> run_scenarios(const Rooms& rooms, const FallthroughCommand& command, int threads) {
  const auto room_of = [&](int number) { return static_cast<std::size_t>(number) % rooms.size(); };
  std::deque<std::future<std::unique_ptr<PreparedScenario>>> ahead;
  int next = 0;
  const auto prepare_next = [&] {
    const ScenarioRoom& room = rooms[room_of(next)]->scanned.simulated;
    ahead.push_back(std::async(std::launch::async, [&room, seed = command.seed, number = next] {
      return std::make_unique<PreparedScenario>(room, seed, number);
    }));
    ++next;
  };
  Progress progress("scenarios", command.scenarios);
  std::vector<ScenarioRow> rows;
  CyberRadar radar;
  for (int number = 0; number < command.scenarios; ++number) {
    while (next < command.scenarios && ahead.size() < static_cast<std::size_t>(threads)) prepare_next();
    const std::unique_ptr<PreparedScenario> prepared = ahead.front().get();
    ahead.pop_front();
    MappedRoom& room = *rooms[room_of(number)];
    rows.push_back(row_of(prepared->scenario, room_of(number), room.scanned.title));
    for (std::size_t i = 0; i < kPolicyCount; ++i)
      rows.back().trials[i] = run_trial(*prepared, room, i, radar);
    progress.step(room.scanned.title);
  }
  return rows;
}

}  // namespace

int run(const FallthroughCommand& command) {
  Report report;
  report.command = "fallthrough";
  report.source = "simulated rooms";
  const RoomScan scan;
  report.settings = {{"scenarios", command.scenarios},
                     {"seed", command.seed},
                     {"random_rooms", command.random_rooms},
                     {"resolution_m", scan.resolution_m}};
  for (const std::string& path : {command.report, command.csv}) require_writable(path);
  const int threads = command.threads > 0
                          ? command.threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));

  GlContext context;
  report.renderer = context.renderer();
  const Rooms rooms = report.times.timed(
      "prescan", [&] { return map_rooms(context, choose_rooms(command.random_rooms), scan, threads); });
  const std::vector<ScenarioRow> rows =
      report.times.timed("scenarios", [&] { return run_scenarios(rooms, command, threads); });

  const auto totals = totals_of(rows);
  std::printf("%d scenarios, seed %llu, %zu rooms, %s\n%s", command.scenarios,
              static_cast<unsigned long long>(command.seed), rooms.size(), context.renderer().c_str(),
              table_of(totals, command.scenarios).c_str());
  report.results["scenarios"] = command.scenarios;
  report.results["policies"] = to_json(totals);
  report.results["failures"] = failures_of(rows);
  write_csv(rows, command.csv);
  write_report(report, command.report);
  return 0;
}

}  // namespace roomradar
