// prescan_command.cpp: roomradar prescan: scans a room once and saves it as a map.
#include "app/commands/prescan_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <new>

#include "app/cli/apply_scan_quality.hpp"
#include "app/cli/interrupt.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report.hpp"
#include "app/commands/unfinished_scan.hpp"
#include "app/evaluation/held_out.hpp"
#include "app/quality/quality_json.hpp"
#include "app/sources/recordings/spooled_source.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/octree/memory_use.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

nlohmann::json hole_row(const Hole& hole) {
  return {{"kind", to_string(hole.kind)},
          {"position_m", to_json(hole.position_world)},
          {"size_m", hole.size_m},
          {"area_m2", hole.area_m2},
          {"look_direction", to_json(hole.look_direction_world)},
          {"stand_m", hole.viewpoint_world ? to_json(*hole.viewpoint_world) : nlohmann::json(nullptr)}};
}

nlohmann::json results_of(const PrescanResult& scanned) {
  const PrescanCounts& counts = scanned.counts;
  const MapCounts octree = scanned.map.octree.counts();
  nlohmann::json results = {
      {"frames_tracked", counts.frames_tracked},
      {"frames_fused", counts.frames_fused},
      {"frames_lost", counts.frames_lost},
      {"keyframes", counts.keyframes},
      {"loops_found", counts.loops_found},
      {"ghost_voxels", counts.ghost_voxels},
      {"frames_resumed", counts.frames_resumed},
      {"stopped_for_memory", counts.stopped_for_memory},
      {"up_source", scanned.map.info.up_source},
      {"map",
       {{"leaves", octree.occupied_leaves + octree.free_leaves},
        {"occupied_leaves", octree.occupied_leaves},
        {"free_leaves", octree.free_leaves},
        {"bytes", octree.memory_bytes},
        {"triangles", scanned.map.mesh.triangles.size()}}},
      {"surface",
       {{"full_triangles", scanned.surface.full_triangles}, {"deviation_m", scanned.surface.deviation_m}}},
  };
  results["holes"] = nlohmann::json::array();
  for (const Hole& hole : scanned.holes) results["holes"].push_back(hole_row(hole));
  results["ate_rmse_m"] = nullptr;  // set only for tracked poses of a recording that has poses
  if (counts.trajectory_error) {
    results["ate_rmse_m"] = counts.trajectory_error->rmse_m;
    results["ate_max_m"] = counts.trajectory_error->max_m;
  }
  if (!counts.last_fault.empty()) results["last_fault"] = counts.last_fault;
  return results;
}

nlohmann::json held_out_json(const HeldOutScore& score) {
  // Figures that could not be measured are omitted; as 0 they would look perfect.
  if (score.frames == 0) return {{"frames", 0}};
  if (score.cover == 0.0) return {{"frames", score.frames}, {"pixels", score.pixels}, {"cover", 0.0}};
  return {{"frames", score.frames}, {"pixels", score.pixels}, {"median_m", score.median_m},
          {"bias_m", score.bias_m}, {"cover", score.cover},   {"outliers", score.outliers}};
}

void print_summary(const PrescanOptions& options, const PrescanResult& scanned,
                   const std::optional<HeldOutScore>& held_out) {
  const PrescanCounts& counts = scanned.counts;
  std::printf("%s: %lld of %lld frames tracked, %lld fused, %zu triangles, up from %s\n", options.map.c_str(),
              static_cast<long long>(counts.frames_tracked), static_cast<long long>(counts.frames_read),
              static_cast<long long>(counts.frames_fused), scanned.map.mesh.triangles.size(),
              scanned.map.info.up_source.c_str());
  if (counts.frames_skipped > 0) {
    std::printf("%lld frames could not be read; the last fault: %s\n",
                static_cast<long long>(counts.frames_skipped), counts.last_fault.c_str());
  }
  if (scanned.map.info.up_source == to_string(UpSource::kNone))
    std::printf(
        "the up direction is not known: no gravity was recorded and no level surface was found; up is taken "
        "from the first camera\n");
  if (counts.trajectory_error)
    std::printf("trajectory against the recorded poses: RMSE %.1f mm, max %.1f mm\n",
                1e3 * counts.trajectory_error->rmse_m, 1e3 * counts.trajectory_error->max_m);
  if (held_out && held_out->frames == 0)
    std::printf(
        "no frame was held out that has a pose: --hold-out %lld means frame %lld and every %lldth after it\n",
        static_cast<long long>(options.hold_out), static_cast<long long>(options.hold_out / 2),
        static_cast<long long>(options.hold_out));
  else if (held_out && held_out->cover == 0.0)
    std::printf("%lld frames held out: the mesh is nowhere in their view\n",
                static_cast<long long>(held_out->frames));
  else if (held_out)
    std::printf("%lld frames held out: depth against the mesh %.1f mm median, %.2f %% covered\n",
                static_cast<long long>(held_out->frames), 1e3 * held_out->median_m, 1e2 * held_out->cover);
}

constexpr double kMB = 1e6;

/// Estimates and prints the scan's memory before it begins.
void announce_memory(FrameSource& source, const PrescanConfig& config, Report& report) {
  const auto cap_bytes = static_cast<double>(config.max_memory_bytes);
  const std::optional<MemoryEstimate> estimate = estimate_memory(source, config.resolution_m);
  if (!estimate) return;
  std::fprintf(stderr, "expected: octree %.0f MB, process at most %.0f MB, for %lld frames%s\n",
               estimate->octree_bytes / kMB, estimate->process_bytes / kMB,
               static_cast<long long>(estimate->frames), estimate->length_known ? "" : " (a minute)");
  if (cap_bytes > 0.0 && estimate->process_bytes > cap_bytes)
    std::fprintf(
        stderr,
        "which is more than --max-memory %.0f: the scan may stop early; a coarser --resolution needs less\n",
        cap_bytes / kMB);
  report.results["memory_estimate"] = {{"octree_mb", estimate->octree_bytes / kMB},
                                       {"process_mb", estimate->process_bytes / kMB},
                                       {"frames", estimate->frames}};
}

/// Prints the largest holes that a scan from more positions would close.
void print_holes(const std::vector<Hole>& holes) {
  constexpr std::size_t kShown = 5;
  const std::size_t inside = static_cast<std::size_t>(std::count_if(
      holes.begin(), holes.end(), [](const Hole& hole) { return hole.kind != HoleKind::kOuterBorder; }));
  if (inside == 0) std::printf("everything inside the scan was observed\n");
  for (std::size_t i = 0; i < std::min(inside, kShown); ++i)
    std::printf("not observed: %s\n", describe(holes[i]).c_str());
  if (inside > kShown) std::printf("and %zu smaller ones\n", inside - kShown);
}

constexpr const char* kStops =
    "\nroomradar: stops before the next frame, without a map; after the last frame the map is still made. "
    "Press Ctrl-C again to end at once\n";

struct StoppedByUser : Error {
  using Error::Error;
};

/// Throws StoppedByUser, with advice on how to continue.
[[noreturn]] void stop(const std::string& map, Checkpoints* checkpoints) {
  const bool resumable = checkpoints && checkpoints->has_any();
  throw StoppedByUser(
      map + ": stopped by Ctrl-C; no map was saved" +
      (resumable ? ", and the same command with --resume continues from the last checkpoint" : ""));
}

bool holds_frames(const std::filesystem::path& spool) {
  return !spool.empty() && SpooledSource::has_frames(spool);
}

/// Throws Error with the fault and, if the scan is not lost, advice on how to continue.
[[noreturn]] void fail(const std::string& fault, const ScanStart& start) {
  const bool is_kept = start.checkpoints && (start.checkpoints->has_any() || holds_frames(start.spool));
  if (!is_kept) {
    if (start.checkpoints) start.checkpoints->remove();  // an empty spool would block the name
    throw Error(fault);
  }
  throw Error(fault + "\nroomradar: what was scanned is kept in " + start.checkpoints->folder().string() +
              ": the same command with --resume continues from there; delete it to start again");
}

/// Calls act(), which scans or saves; errors say whether the scan can be resumed.
template <typename Act>
auto or_say_what_is_kept(const ScanStart& start, const Act& act) {
  try {
    return act();
  } catch (const StoppedByUser&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail("memory ran out; close other programs, or give --max-memory", start);
  } catch (const std::exception& error) {  // also those of libraries
    fail(error.what(), start);
  }
}

/// Returns the beginning of a sentence.
std::string stopped_for_memory(const PrescanOptions& options, bool keep_frames) {
  return options.source + ": stopped by --max-memory " + std::to_string(std::llround(options.max_memory_mb)) +
         ": " +
         (keep_frames ? "its frames are kept, and the same command with --resume scans them again; " : "");
}

/// Called once the map is saved, or will not be: deletes the checkpoints and, unless keep_frames, the stored
/// frames of a live scan.
void finish(Checkpoints& checkpoints, bool keep_frames) {
  if (keep_frames)
    checkpoints.forget();
  else
    checkpoints.remove();
  if (checkpoints.failures() > 0)
    std::fprintf(stderr, "roomradar: %s: %lld checkpoints could not be written; is the disk full?\n",
                 checkpoints.folder().c_str(), static_cast<long long>(checkpoints.failures()));
}

}  // namespace

int run(const PrescanOptions& options) {
  mmap_large_allocations();
  Report report;
  report.command = "prescan";
  report.source = options.source;
  report.settings = {{"map", options.map}, {"poses", to_string(options.poses)}};
  report.settings.update(to_json(options.quality));
  if (!options.preset.empty()) report.settings["preset"] = options.preset;
  if (!options.presets.empty()) report.settings["presets"] = options.presets;
  if (options.hold_out > 0) report.settings["hold_out"] = options.hold_out;
  if (options.max_memory_mb > 0.0) report.settings["max_memory_mb"] = options.max_memory_mb;
  if (!options.calibration.empty()) report.settings["calibration"] = options.calibration;
  if (options.frames) report.settings["frames"] = {options.frames->first, options.frames->last};

  PrescanConfig config;
  apply(options.quality, config);
  config.poses = options.poses;
  config.hold_out = options.hold_out;
  config.max_memory_bytes = static_cast<std::size_t>(1e6 * options.max_memory_mb);
  // Recorded poses may disagree with the depth by more than the threshold that tells a ghost from a wall;
  // ghost removal would then erase walls.
  config.remove_ghosts = options.poses == PoseOrigin::kTracked;
  require_can_become_map(options.map, {options.report});
  require_writable(options.report);
  ScanStart start = start_scan(options);
  if (start.is_done) {
    std::printf("%s: holds %s already; there is nothing to resume (another recording needs another name)\n",
                options.map.c_str(), options.source.c_str());
    report.results["held_already"] = true;
    write_report(report, options.report);
    return 0;
  }
  const std::unique_ptr<FrameSource>& source = start.source;
  const Interrupt interrupt;
  if (!start.is_live) Interrupt::say(kStops);
  if (start.map) {
    config.resolution_m = start.map->octree.resolution_m();
    std::map<std::string, std::string>& kept = start.map->info.settings;
    const bool is_asked_for = std::any_of(options.fixed.begin(), options.fixed.end(),
                                          [](const auto& field) { return field.first == "deviation_m"; });
    if (!is_asked_for && kept.contains(kDeviationSetting))
      config.surface.max_deviation_m = surface_config_of(start.map->info).max_deviation_m;
    kept[kDeviationSetting] = format_number(config.surface.max_deviation_m);
    report.settings["resolution_m"] = config.resolution_m;
    report.settings["deviation_m"] = nlohmann::json::parse(kept[kDeviationSetting]);
    if (config.resolution_m != options.quality.resolution_m ||
        config.surface.max_deviation_m != static_cast<float>(options.quality.deviation_m))
      std::fprintf(stderr, "%s: is extended, and keeps its cells of %g m and its --deviation of %g m\n",
                   options.map.c_str(), config.resolution_m,
                   static_cast<double>(config.surface.max_deviation_m));
  }
  announce_memory(*source, config, report);

  std::unique_ptr<Progress> progress;
  if (start.checkpoints)
    start.checkpoints->tell_failure([](const std::string& sentence) {
      // On a terminal the progress line has no line end.
      std::fprintf(stderr, "%sroomradar: %s\n", isatty(STDERR_FILENO) != 0 ? "\n" : "", sentence.c_str());
    });
  std::string stage_shown;
  const auto show = [&](const std::string& stage, const std::string& note) {
    if (stage_shown.empty() && start.checkpoints)  // the checkpoints have been read
      for (const std::string& fault : start.checkpoints->faults())
        std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
    if (stage != stage_shown) {
      progress.reset();
      // The passes of ghost removal read only parts of the source, some twice.
      progress = std::make_unique<Progress>(stage, stage == "ghosts" ? std::nullopt : source->frame_count());
      stage_shown = stage;
      if (stage != "track") Interrupt::say(kStops);
    }
    progress->step(note);
    const bool ends_by_itself = start.is_live && stage == "track";
    if (!ends_by_itself && Interrupt::take()) stop(options.map, start.checkpoints.get());
  };
  const bool extends = start.map.has_value();
  const PrescanResult scanned = or_say_what_is_kept(start, [&] {
    return prescan(*source, config, report.times, show, {start.checkpoints.get(), std::move(start.map)});
  });
  progress.reset();
  const bool was_stopped = scanned.counts.stopped_for_memory;
  const bool keep_frames = was_stopped && !start.spool.empty();
  report.frames_read = scanned.counts.frames_read;
  report.frames_skipped = scanned.counts.frames_skipped;
  report.results.update(results_of(scanned));
  if (extends && was_stopped) {
    if (start.checkpoints) finish(*start.checkpoints, keep_frames);
    write_report(report, options.report);
    throw Error(
        stopped_for_memory(options, keep_frames) + options.map +
        " is unchanged, because the rest could not be added later; with more memory it is added completely");
  }
  or_say_what_is_kept(start,
                      [&] { report.times.timed("save", [&] { save_map(options.map, scanned.map); }); });

  std::optional<HeldOutScore> held_out;
  std::string not_scored;
  if (options.hold_out > 0) {
    // An extended map's last poses are this scan's.
    const std::vector<TimedPose> poses(scanned.map.trajectory.end() - scanned.counts.frames_tracked,
                                       scanned.map.trajectory.end());
    try {
      held_out = report.times.timed(
          "held_out", [&] { return score_held_out(*source, scanned.map.mesh, poses, options.hold_out); });
      report.results["held_out"] = held_out_json(*held_out);
    } catch (const Error& error) {
      not_scored = error.what();
    }
  }
  if (start.checkpoints) finish(*start.checkpoints, keep_frames);
  print_summary(options, scanned, held_out);
  print_holes(scanned.holes);
  write_report(report, options.report);
  if (!not_scored.empty())
    std::fprintf(stderr, "roomradar: %s: is saved; its held-out frames could not be compared with it: %s\n",
                 options.map.c_str(), not_scored.c_str());
  if (!was_stopped) return not_scored.empty() ? 0 : 1;
  throw Error(stopped_for_memory(options, keep_frames) + "the map of the " +
              std::to_string(scanned.counts.frames_fused) + " fused frames is saved and complete; " +
              (keep_frames
                   ? "with more memory the rest is included"
                   : "with a coarser --resolution or more memory the rest is included, from the beginning"));
}

}  // namespace roomradar
