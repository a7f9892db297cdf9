// farm_command.cpp: roomradar farm: runs the jobs that are not done, or prints a script that does.
#include "app/commands/farm_command.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "app/cli/interrupt.hpp"
#include "app/cli/program_beside.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report.hpp"
#include "app/commands/commands.hpp"
#include "app/farm/farm.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

std::string_view to_string(JobState state) {
  switch (state) {
    case JobState::kNotPlanned:
      return "not planned";
    case JobState::kWaiting:
      return "waiting";
    case JobState::kRunning:
      return "running";
    case JobState::kPresent:
      return "present";
    case JobState::kDone:
      return "done";
    case JobState::kFailed:
      return "failed";
    case JobState::kSkipped:
      return "skipped";
  }
  return "?";
}

nlohmann::json rows_of(const FarmPlan& plan, const FarmState& state) {
  nlohmann::json rows = nlohmann::json::array();
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    if (state.schedule.state(i) == JobState::kNotPlanned) continue;
    nlohmann::json row = {{"name", plan.manifest.jobs[i].name},
                          {"state", to_string(state.schedule.state(i))}};
    if (const auto found = state.results.find(i); found != state.results.end()) {
      const JobResult& result = found->second;
      row.update({{"wall_s", result.wall_s}, {"cpu_s", result.cpu_s}, {"peak_rss_mb", result.peak_mb}});
    }
    if (const std::string fault = fault_of(plan, state, i); !fault.empty()) row["fault"] = fault;
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Prints the first faults, and how many jobs ended how.
/// @param wanted  names of jobs of which it is also said why they were skipped
void print_state(const FarmPlan& plan, const FarmState& state, const std::vector<std::string>& wanted) {
  constexpr int kMostFaults = 10;
  int faults = 0;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i) {
    const std::string& name = plan.manifest.jobs[i].name;
    const bool has_failed = state.schedule.state(i) == JobState::kFailed && state.results.contains(i);
    const bool is_said = has_failed || (state.schedule.state(i) == JobState::kSkipped &&
                                        std::find(wanted.begin(), wanted.end(), name) != wanted.end());
    if (!is_said || ++faults > kMostFaults) continue;
    std::fprintf(stderr, "roomradar: %s: %s\n", name.c_str(), fault_of(plan, state, i).c_str());
  }
  if (faults > kMostFaults) std::fprintf(stderr, "roomradar: and %d more\n", faults - kMostFaults);
  const Schedule& schedule = state.schedule;
  std::printf(
      "%s: %zu jobs done, %zu were done before, %zu failed, %zu skipped because they need a failed one\n",
      plan.out.c_str(), schedule.count(JobState::kDone), schedule.count(JobState::kPresent),
      schedule.count(JobState::kFailed), schedule.count(JobState::kSkipped));
}

}  // namespace

FarmPlan plan_of(const FarmOptions& options) {
  Manifest manifest = read_manifest(options.manifest);
  std::vector<std::size_t> wanted;
  for (const std::string& name : options.jobs) wanted.push_back(index_of(manifest, name));
  return plan_farm(std::move(manifest), options.out, wanted);
}

FarmState run_planned(const FarmOptions& options, const FarmPlan& plan, const RunJobs& run_jobs) {
  Report report;
  report.command = "farm";
  report.source = options.manifest;
  const auto waiting = static_cast<std::int64_t>(Schedule(plan).count(JobState::kWaiting));
  FarmState state = report.times.timed("jobs", [&] {
    Progress progress("jobs", waiting);
    return run_jobs([&](const FarmState& now, std::size_t job) {
      const std::size_t failed = now.schedule.count(JobState::kFailed);
      progress.step(plan.manifest.jobs[job].name +
                    (failed > 0 ? "; " + std::to_string(failed) + " failed" : ""));
    });
  });
  print_state(plan, state, options.jobs);
  report.settings = {{"out", options.out}};
  report.results["jobs"] = rows_of(plan, state);
  for (const JobState one : {JobState::kDone, JobState::kPresent, JobState::kFailed, JobState::kSkipped})
    report.results["jobs_" + std::string(to_string(one))] = state.schedule.count(one);
  write_report(report, options.report);
  return state;
}

namespace {

/// Runs a plan on this machine, until it is done or Ctrl-C is pressed, which throws Error.
/// @param program_name  name of the program that does the jobs
FarmState run_here(const FarmOptions& options, const FarmPlan& plan, const std::string& program_name) {
  const std::filesystem::path program = program_beside(program_name);
  const int processes = given_or_processors(options.processes);
  const Interrupt interrupt;
  Interrupt::say("roomradar: stopping the running jobs; the same command continues them later\n");
  FarmState state = run_planned(options, plan, [&](const WatchFarm& watch) {
    return run_farm(plan, processes, program, Interrupt::was_pressed, watch);
  });
  if (Interrupt::was_pressed())
    throw Error(options.out + ": stopped by Ctrl-C; run the same command again to finish the rest");
  return state;
}

}  // namespace

int exit_status(const FarmState& state) {
  return state.schedule.count(JobState::kFailed) + state.schedule.count(JobState::kSkipped) > 0 ? 1 : 0;
}

int run(const FarmOptions& options) {
  require_contents_outside_maps(options.out);
  require_writable(options.report);
  const FarmPlan plan = plan_of(options);
  if (options.emit) {
    std::fputs(batch_script(plan, *options.emit, program_beside("roomradar")).c_str(), stdout);
    return 0;
  }
  return exit_status(run_here(options, plan, "roomradar"));
}

JobFaults run_split(const std::string& folder, const std::string& manifest, const std::string& program,
                    const std::vector<std::string>& jobs, int processes) {
  FarmOptions options;
  options.manifest = (std::filesystem::path(folder) / "jobs.txt").string();
  options.out = folder;
  options.processes = processes;
  options.jobs = jobs;
  require_contents_outside_maps(folder);
  make_folder(folder);
  write_bytes(options.manifest, manifest);
  const FarmPlan plan = plan_of(options);
  const FarmState state = run_here(options, plan, program);
  JobFaults faults;
  for (std::size_t i = 0; i < plan.jobs.size(); ++i)
    if (std::string fault = fault_of(plan, state, i); !fault.empty())
      faults.emplace(plan.manifest.jobs[i].name, std::move(fault));
  return faults;
}

}  // namespace roomradar
