// run_command.cpp: roomradar run: augmented reality in a saved room.
#include "app/commands/scan_and_play.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/deferred_errors.hpp"
#include "app/run/opened_run.hpp"
#include "app/run/run_loop.hpp"
#include "app/run/run_results.hpp"
#include "app/run/run_summary.hpp"
#include "mapping/history/visits.hpp"
#include "mapping/map/changed_map.hpp"
#include "mapping/map/map_history.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Saves the map as changed by the session.
void save_changed(OpenedRun& run) {
  const std::vector<CommittedChange>& changes = run.session->committed_changes();
  run.map.made = {"run", without_folders(run.options.source), {}};
  for (const CommittedChange& change : changes)
    run.map.made.changes.push_back(
        {change.kind == LastingKind::kCame ? "appeared" : "vanished", change.box_world});
  save_changed_map(run.map, changes.size(), run.options.save_map);
  std::printf("%s: saved with %zu changes\n", run.options.save_map.c_str(), changes.size());
}

/// Returns why all objects that a run was to drop or place are still out of the room; empty if one was in it.
std::string why_nothing_dropped(const OpenedRun& run) {
  if (run.options.window || run.is_replay) return {};
  if (has<RemoveObject>(run.script)) return {};  // an object may have been in the room
  const std::vector<WaitingDrop>& waiting = run.session->waiting_drops();
  for (const auto& object : run.session->objects())
    if (object->in_room || object->departures > 0) return {};
  if (!waiting.empty())
    return "no object could be dropped: " + waiting.front().why +
           ". Choose a place with --script and drop NAME at X Y Z; `roomradar map info " + run.options.map +
           "` lists the level surfaces";
  return run.totals.places_refused > 0 ? "no object could be placed" : "";
}

/// Plays the run, saves, reports and prints its results; returns the exit status.
int play(OpenedRun& run) {
  const RunOptions& options = run.options;
  const RunTotals& totals = run.totals;
  DeferredErrors faults;
  faults.attempt([&] { play_to_end(run); });
  if (totals.located > 0 && faults.first().empty()) run.nothing_dropped = why_nothing_dropped(run);
  const RunEnd end = run.nothing_dropped.empty() ? RunEnd::kNormal : RunEnd::kNothingDropped;
  for (const std::unique_ptr<FrameSink>& sink : run.sinks) faults.attempt([&] { sink->finish(end); });
  if (totals.read == totals.skipped) {
    faults.throw_first();
    if (run.host && run.host->is_closed()) return 0;  // before the first frame
    throw Error(options.source + ": there is no readable frame" +
                (totals.last_fault.empty() ? "" : "; the last fault: " + totals.last_fault));
  }
  faults.attempt([&] {
    run.session->finish_commits();
    if (!options.save_map.empty()) save_changed(run);
  });
  run.report.frames_read = totals.read;
  run.report.frames_skipped = totals.skipped + totals.dropped.count;
  run.report.results = results_of(totals, *run.session);
  if (run.input_lines) run.input_lines->say();
  run.report.results["input"] = to_json(run.input->decisions());
  if (run.budget) run.report.results["budget"] = run.budget->report();
  for (const std::unique_ptr<FrameSink>& sink : run.sinks) sink->report(run.report.results);
  if (!faults.first().empty()) run.report.results["fault"] = faults.first();
  faults.attempt([&] { write_report(run.report, options.report); });
  print_summary(run);
  faults.throw_first();
  if (!run.nothing_dropped.empty()) {
    std::fprintf(stderr, "roomradar: %s: %s%s\n", options.source.c_str(), run.nothing_dropped.c_str(),
                 options.video.empty() ? "" : ("; " + options.video + " is not written").c_str());
    return 1;
  }
  if (totals.located > 0 || run.was_quit) return 0;
  if (options.poses == PoseOrigin::kRecorded) {
    std::fprintf(stderr, "roomradar: %s: no frame has a recorded pose; use --poses tracked\n",
                 options.source.c_str());
    return 1;
  }
  std::fprintf(
      stderr,
      "roomradar: %s: the camera was not localised in %s in any frame; does the map show this room?\n",
      options.source.c_str(), options.map.c_str());
  return 1;
}

/// Returns the place to scan under the first object that rests on the border of unknown space, and a
/// viewpoint.
std::optional<PlaceToScan> place_to_scan(const Session& session) {
  for (const auto& object : session.objects()) {
    if (!object->in_room || !rests_on_unknown(*object)) continue;
    const auto viewpoint =
        viewpoint_of_support(*object, session.scene_without(object.get()), camera_position_world(session));
    if (viewpoint) return PlaceToScan{support_point_world(*object), *viewpoint};
  }
  return std::nullopt;
}

RunOptions with_map(RunOptions options, const OpenedMap& opened) {
  options.map = opened.folder().string();
  return options;
}

}  // namespace

int play(const RunOptions& options) {
  const OpenedMap opened(options.map);
  const RunOptions in_folder = with_map(options, opened);
  return play(*open_run(in_folder, nullptr));
}

PlayResult play_in_window(const RunOptions& options) {
  std::vector<ObjectSource> meshes;
  for (const ObjectOption& object : options.objects)
    if (object.source.mesh != "teapot") meshes.push_back(object.source);
  const OpenedMap opened(options.map);
  const RunOptions in_folder = with_map(options, opened);
  PlayResult result;
  result.window = run_in_window("roomradar - " + options.source, meshes, options.budget_ms, options.ui_scale,
                                [&](UiChannel& link) {
                                  const std::unique_ptr<OpenedRun> run = open_run(in_folder, &link);
                                  const int status = play(*run);
                                  if (link.wants_to_scan()) result.look_at = place_to_scan(*run->session);
                                  return status;
                                });
  return result;
}

}  // namespace roomradar
