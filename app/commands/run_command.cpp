// run_command.cpp: roomradar run: augmented reality in a saved room.
#include "app/commands/run_command.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/deferred_errors.hpp"
#include "app/run/opened_run.hpp"
#include "app/run/run_loop.hpp"
#include "app/run/run_results.hpp"
#include "app/run/run_summary.hpp"
#include "mapping/map/changed_map.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Saves the map as changed by the session.
void save_changed(SavedMap& map, std::size_t changes, const std::string& folder) {
  save_changed_map(map, changes, folder);
  std::printf("%s: saved with %zu changes\n", folder.c_str(), changes);
}

/// Prints to stderr how a replay compares with the recorded results.
nlohmann::json report_replay(const ReplayCheck& check) {
  std::fprintf(stderr, "replay: %lld of %lld frames the same as recorded",
               static_cast<long long>(check.same()), static_cast<long long>(check.recorded()));
  if (check.different() > 0)
    std::fprintf(stderr, ", the first that is not: %lld", static_cast<long long>(check.first_different()));
  std::fprintf(stderr, "\n");
  return {{"same", check.same()}, {"different", check.different()}, {"recorded", check.recorded()}};
}

/// Closes the stream of frames, and prints how many lines its reader did not get.
void close_stream(OpenedRun& run) {
  const LineStream& lines = run.stream->lines();
  run.stream->close();
  if (lines.is_reader_gone())
    std::fprintf(stderr, "--stream: its reader closed it before the run's end; %lld lines were dropped\n",
                 static_cast<long long>(lines.dropped()));
  else if (lines.dropped() > 0)
    std::fprintf(stderr, "--stream: its reader was too slow; %lld lines were dropped\n",
                 static_cast<long long>(lines.dropped()));
}

/// Returns why all objects that a run was to drop or place are still out of the room; empty if one was in it.
std::string why_nothing_dropped(const OpenedRun& run) {
  if (run.options.window || run.check) return {};
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
  const std::string nothing_dropped =
      totals.located > 0 && faults.first().empty() ? why_nothing_dropped(run) : "";
  if (run.video && !nothing_dropped.empty()) {
    run.video->discard();
    run.video.reset();
  }
  if (run.video) faults.attempt([&] { run.video->close(); });
  if (run.frames_csv) faults.attempt([&] { run.frames_csv->close(); });
  if (run.trajectory) faults.attempt([&] { run.trajectory->close(); });
  if (run.stream) faults.attempt([&] { close_stream(run); });
  if (totals.read == totals.skipped) {
    faults.throw_first();
    if (run.host && run.host->is_closed()) return 0;  // before the first frame
    throw Error(options.source + ": there is no readable frame" +
                (totals.last_fault.empty() ? "" : "; the last fault: " + totals.last_fault));
  }
  faults.attempt([&] {
    run.session->finish_commits();
    if (!options.save_map.empty())
      save_changed(run.map, run.session->committed_changes().size(), options.save_map);
  });
  run.report.frames_read = totals.read;
  run.report.frames_skipped = totals.skipped + totals.dropped.count;
  run.report.results = results_of(totals, *run.session);
  if (run.input_lines) run.input_lines->say();
  run.report.results["input"] = to_json(run.input->decisions());
  if (run.stream) run.report.results["stream_lines_dropped"] = run.stream->lines().dropped();
  if (run.budget) run.report.results["budget"] = run.budget->report();
  if (run.check) run.report.results["replay"] = report_replay(*run.check);
  if (!faults.first().empty()) run.report.results["fault"] = faults.first();
  faults.attempt([&] { write_report(run.report, options.report); });
  print_summary(run);
  faults.throw_first();
  if (!nothing_dropped.empty()) {
    std::fprintf(stderr, "roomradar: %s: %s%s\n", options.source.c_str(), nothing_dropped.c_str(),
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

}  // namespace

int play(const RunOptions& options) { return play(*open_run(options, nullptr)); }

PlayResult play_in_window(const RunOptions& options) {
  std::vector<ObjectSource> meshes;
  for (const ObjectOption& object : options.objects)
    if (object.source.mesh != "teapot") meshes.push_back(object.source);
  PlayResult result;
  result.window = run_in_window("roomradar - " + options.source, meshes, options.budget_ms, options.ui_scale,
                                [&](UiChannel& link) {
                                  const std::unique_ptr<OpenedRun> run = open_run(options, &link);
                                  const int status = play(*run);
                                  if (link.wants_to_scan()) result.look_at = place_to_scan(*run->session);
                                  return status;
                                });
  return result;
}

}  // namespace roomradar
