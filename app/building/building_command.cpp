// building_command.cpp: option names, help texts and checks; the report and the summary.
#include "app/building/building_command.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "app/cli/interrupt.hpp"
#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/shared_options.hpp"
#include "app/cli/program_beside.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

BuildingWork work_of(const BuildingOptions& options) {
  BuildingWork work;
  work.folder = fs::absolute(options.folder).lexically_normal();
  if (work.folder.filename().empty()) work.folder = work.folder.parent_path();  // DIR/
  work.list_folder = fs::absolute(options.recordings).lexically_normal().parent_path();
  work.recordings = read_recording_list(options.recordings);
  work.grid = options.grid;
  work.poses = options.poses;
  work.deviation_m = options.deviation_m;
  require_contents_outside_maps(work.folder);
  std::error_code ignored;
  if (fs::is_directory(work.folder, ignored) && !is_empty_folder(work.folder, ignored) &&
      !is_building(work.folder) && !fs::exists(work.jobs(), ignored))
    throw Error(work.folder.string() + ": is a folder of something else; take the name of a new folder");
  return work;
}

json stages_json(const BuildingResult& result) {
  json stages = json::object();
  for (const StageCounts& one : result.stages)
    stages[one.stage] = {{"jobs_done", one.done},     {"jobs_present", one.present},
                         {"jobs_failed", one.failed}, {"wall_s", one.wall_s},
                         {"cpu_s", one.cpu_s},        {"peak_rss_mb", one.peak_mb}};
  return stages;
}

json joins_json(const BuildingResult& result) {
  json joins = json::array();
  for (const JoinedPair& pair : result.joins)
    joins.push_back({{"a", pair.a.name()},
                     {"b", pair.b.name()},
                     {"outcome", describe(pair.join)},
                     {"is_joined", pair.join.status == JoinStatus::kJoined},
                     {"is_used", pair.is_used},
                     {"agreeing", pair.join.agreeing},
                     {"expected", pair.join.expected},
                     {"recognised", pair.join.recognised},
                     {"agreement", pair.join.agreement},
                     {"links", pair.join.links.size()},
                     {"off_m", pair.off_m}});
  return joins;
}

void print_summary(const BuildingOptions& options, const BuildingResult& result) {
  std::int64_t triangles = 0;
  std::uintmax_t bytes = 0;
  for (const BuildingTile& tile : result.info.tiles) {
    triangles += tile.triangles;
    for (const ContentFile* file : files_of(tile)) bytes += file->bytes;
  }
  std::printf("%s: %zu tiles, %lld triangles, %.1f MB\n", options.folder.c_str(), result.info.tiles.size(),
              static_cast<long long>(triangles), 1e-6 * static_cast<double>(bytes));
  for (const BuildingRecording& one : result.info.recordings) {
    if (one.frames_placed == one.frames_tracked) continue;
    const std::string which =
        one.frames_placed == 0
            ? std::string("not in it")
            : std::to_string(one.frames_tracked - one.frames_placed) + " of its frames are not in it";
    std::printf(
        "  %s: %s, since no other recording shows a place of these for certain; record a walk that joins "
        "them\n",
        one.name.c_str(), which.c_str());
  }
  if (result.recorded_error.poses > 0)
    std::printf("positions against the recorded ones: RMSE %.1f mm, at most %.1f mm\n",
                1e3 * result.recorded_error.rmse_m, 1e3 * result.recorded_error.max_m);
}

}  // namespace

int run_building(const BuildingOptions& options, const RunStage& run_stage) {
  require_writable(options.report);
  const BuildingWork work = work_of(options);
  Report report;
  report.command = "building";
  report.source = options.recordings;
  report.settings = {{"resolution_m", options.grid.resolution_m},
                     {"tile_edge_voxels", options.grid.edge_voxels},
                     {"deviation_m", options.deviation_m},
                     {"poses", to_string(options.poses)}};
  const BuildingResult result = build_building(
      work, run_stage, [](const std::string& sentence) { std::fprintf(stderr, "%s\n", sentence.c_str()); });
  for (const BuildingRecording& one : result.info.recordings) report.frames_read += one.frames_read;
  json recordings = json::array();
  for (const BuildingRecording& one : result.info.recordings)
    recordings.push_back({{"name", one.name},
                          {"frames_read", one.frames_read},
                          {"frames_tracked", one.frames_tracked},
                          {"keyframes", one.keyframes},
                          {"frames_placed", one.frames_placed}});
  report.results = {{"jobs", stages_json(result)},
                    {"joins", joins_json(result)},
                    {"recordings", recordings},
                    {"tiles", result.info.tiles.size()},
                    {"poses_kept", result.kept}};
  if (result.recorded_error.poses > 0) report.results["ate_rmse_m"] = result.recorded_error.rmse_m;
  print_summary(options, result);
  for (const StageCounts& one : result.stages)
    for (const std::string& fault : one.faults) std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  write_report(report, options.report);
  const bool is_whole = std::all_of(result.stages.begin(), result.stages.end(),
                                    [](const StageCounts& one) { return one.failed == 0; });
  return is_whole ? 0 : 1;
}

int run(const BuildingOptions& options) {
  const int processes = given_or_processors(options.processes);
  const Interrupt interrupt;
  Interrupt::say("roomradar: stopping the running jobs; the same command continues them later\n");
  return run_building(options, [&](const std::string& stage, const FarmPlan& plan) {
    const auto waiting = static_cast<std::int64_t>(Schedule(plan).count(JobState::kWaiting));
    Progress progress(stage, waiting);
    return run_farm(
        plan, processes, program_beside("roomradar-building"), Interrupt::was_pressed,
        [&](const FarmState& /*state*/, std::size_t job) { progress.step(plan.manifest.jobs[job].name); });
  });
}

namespace {

template <typename Step>
void add_step(CLI::App& steps, const char* name, const char* description, std::function<int()>& work,
              const std::function<void(CLI::App&, Step&)>& add) {
  CLI::App* command = steps.add_subcommand(name, description);
  const auto step = std::make_shared<Step>();
  add(*command, *step);
  command->add_option("--out", step->out, "folder of the results")->required();
  command->callback([step, &work] { work = [step] { return run(*step); }; });
}

void add_grid(CLI::App& command, TileGrid& grid) {
  command.add_option("--resolution", grid.resolution_m)->required();
  command.add_option("--tile-edge", grid.edge_voxels)->required();
}

}  // namespace

void add_building_steps(CLI::App& app, std::function<int()>& work) {
  CLI::App& steps = *app.add_subcommand("building-step", "one job of `roomradar building`");
  steps.group("");
  steps.require_subcommand(1);
  add_step<TrackStep>(steps, "track", "track one recording", work, [](CLI::App& command, TrackStep& step) {
    command.add_option("SOURCE", step.source)->required();
    add_poses_option(command, step.poses, "whose camera poses to use");
  });
  add_step<RetrieveStep>(steps, "retrieve", "find similar keyframes of recordings", work,
                         [](CLI::App& command, RetrieveStep& step) {
                           command.add_option("FEATURES", step.a)->required();
                           command.add_option("--with", step.b);
                         });
  add_step<JoinStep>(steps, "join", "compare two recordings", work, [](CLI::App& command, JoinStep& step) {
    command.add_option("A", step.a)->required();
    command.add_option("B", step.b)->required();
  });
  add_step<FuseStep>(steps, "fuse", "fuse one recording", work, [](CLI::App& command, FuseStep& step) {
    command.add_option("SOURCE", step.source)->required();
    command.add_option("--submap", step.submaps)->required();
    command.add_option("--placed", step.placed)->required();
    command.add_flag_callback("--keep-ghosts", [&step] { step.remove_ghosts = false; });
    add_grid(command, step.grid);
  });
  add_step<TileStep>(steps, "tile", "add the parts of one tile", work, [](CLI::App& command, TileStep& step) {
    command.add_option("--tile", step.tile)->required();
    command.add_option("PART", step.parts)->required();
    command.add_option("--deviation", step.deviation_m)->required();
    command.add_option("--unknown-cells", step.unknown_cells)->required();
    add_grid(command, step.grid);
  });
}

}  // namespace roomradar
