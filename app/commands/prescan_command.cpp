// prescan_command.cpp: roomradar prescan: scans a room once and saves it as a map.
#include "app/commands/prescan_command.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/apply_scan_quality.hpp"
#include "app/cli/interrupt.hpp"
#include "app/cli/progress.hpp"
#include "app/cli/report.hpp"
#include "app/commands/prescan_report.hpp"
#include "app/commands/unfinished_scan.hpp"
#include "app/evaluation/held_out.hpp"
#include "app/quality/quality_json.hpp"
#include "app/sources/recordings/spooled_source.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/prescan.hpp"
#include "mapping/scan_memory.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

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

constexpr const char* kLookedAt = "looked";  // the note of each frame in which ghosts are searched
constexpr const char* kStops =
    "\nroomradar: stops after the next frame, without a map; after the last frame the map is still made. "
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

nlohmann::json settings_of(const PrescanOptions& options) {
  nlohmann::json settings = {{"map", options.map}, {"poses", to_string(options.poses)}};
  settings.update(to_json(options.quality));
  if (!options.preset.empty()) settings["preset"] = options.preset;
  if (!options.presets.empty()) settings["presets"] = options.presets;
  if (options.up)
    settings["up"] = options.up->up_world ? to_json(*options.up->up_world) : nlohmann::json("camera");
  if (options.hold_out > 0) settings["hold_out"] = options.hold_out;
  if (options.max_memory_mb > 0.0) settings["max_memory_mb"] = options.max_memory_mb;
  if (!options.calibration.empty()) settings["calibration"] = options.calibration;
  if (options.frames) settings["frames"] = {options.frames->first, options.frames->last};
  return settings;
}

PrescanConfig config_of(const PrescanOptions& options) {
  PrescanConfig config;
  apply(options.quality, config);
  config.poses = options.poses;
  config.up = options.up;
  config.hold_out = options.hold_out;
  config.max_memory_bytes = static_cast<std::size_t>(kMB * options.max_memory_mb);
  // Recorded poses may disagree with the depth by more than the threshold that tells a ghost from a wall;
  // ghost removal would then erase walls.
  config.remove_ghosts = options.poses == PoseOrigin::kTracked;
  return config;
}

/// Reports that the map already contains the recording to resume; returns the exit status.
int report_held_already(const PrescanOptions& options, Report& report) {
  std::printf("%s: holds %s already; there is nothing to resume (another recording needs another name)\n",
              options.map.c_str(), options.source.c_str());
  report.results["held_already"] = true;
  write_report(report, options.report);
  return 0;
}

/// Sets the resolution and the mesh's deviation to those of the map that is extended, with a message if they
/// differ from the requested ones. A deviation given as an option takes precedence, and the map keeps it.
void keep_settings_of_map(const PrescanOptions& options, SavedMap& map, PrescanConfig& config,
                          Report& report) {
  config.resolution_m = map.octree->resolution_m();
  std::map<std::string, std::string>& kept = map.info.settings;
  const bool is_asked_for = std::any_of(options.fixed.begin(), options.fixed.end(),
                                        [](const auto& field) { return field.first == "deviation_m"; });
  if (!is_asked_for && kept.contains(kDeviationSetting))
    config.surface.max_deviation_m = surface_config_of(map.info).max_deviation_m;
  kept[kDeviationSetting] = format_number(config.surface.max_deviation_m);
  report.settings["resolution_m"] = config.resolution_m;
  report.settings["deviation_m"] = nlohmann::json::parse(kept[kDeviationSetting]);
  if (config.resolution_m != options.quality.resolution_m ||
      config.surface.max_deviation_m != static_cast<float>(options.quality.deviation_m))
    std::fprintf(stderr, "%s: is extended, and keeps its cells of %g m and its --deviation of %g m\n",
                 options.map.c_str(), config.resolution_m,
                 static_cast<double>(config.surface.max_deviation_m));
}

/// Shows the scan's stages on stderr, and ends the scan on Ctrl-C.
class ScanProgress {
 public:
  ScanProgress(const PrescanOptions& options, const ScanStart& start) : options_(options), start_(start) {}

  /// Call after each frame of a stage. After Ctrl-C it requests a checkpoint of the frames read so far, and
  /// the call after the next frame throws StoppedByUser. No effect in a stage whose source ends by itself.
  void show(const std::string& stage, const std::string& note) {
    if (stage_.empty() && start_.checkpoints)  // the checkpoints have been read
      for (const std::string& fault : start_.checkpoints->faults())
        std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
    if (stage == "surface") {
      progress_.reset();
      std::fprintf(stderr,
                   "surface: is extracted; then what the scan missed is listed, and the map is saved\n");
      return;
    }
    const bool is_again = stage == "ghosts" && note != kLookedAt;
    if (const std::string title = is_again ? "fuse again" : stage; title != stage_) begin(title);
    if (stage == "fuse" && note == to_string(FuseStatus::kFused)) ++fused_;
    progress_->step(is_again && fused_ > 0 ? note + ", of at most " + std::to_string(fused_) : note);
    const bool ends_by_itself = start_.is_live && stage == "track";
    if (is_stopping_) stop(options_.map, start_.checkpoints.get());
    is_stopping_ = !ends_by_itself && Interrupt::take();
    if (is_stopping_ && start_.checkpoints) start_.checkpoints->write_soon();
  }

 private:
  const PrescanOptions& options_;
  const ScanStart& start_;
  std::unique_ptr<Progress> progress_;
  std::string stage_;
  std::int64_t fused_ = 0;  ///< frames fused in this process
  bool is_stopping_ = false;

  /// Returns the number of frames of a stage. The search for ghosts looks at evenly spaced fused frames;
  /// after a resumed scan their number is not known here.
  [[nodiscard]] std::optional<std::int64_t> total_of(const std::string& stage) const {
    if (stage == "fuse again" || (stage == "ghosts" && fused_ == 0)) return std::nullopt;
    if (stage != "ghosts") return start_.source->frame_count();
    const std::int64_t stride = look_stride(fused_, GhostConfig{});
    return (fused_ + stride - 1) / stride;
  }

  void begin(const std::string& stage) {
    progress_.reset();
    progress_ = std::make_unique<Progress>(stage, total_of(stage));
    stage_ = stage;
    if (stage != "track") Interrupt::say(kStops);
  }
};

/// Scans the room; the map to extend is moved from `start`. Errors say whether the scan can be resumed.
/// @param last_frame_s  out: Report::seconds() when the last frame was tracked
PrescanResult scan(const PrescanOptions& options, const PrescanConfig& config, ScanStart& start,
                   Report& report, double& last_frame_s) {
  if (start.checkpoints)
    start.checkpoints->tell_failure([](const std::string& sentence) {
      // On a terminal the progress line has no line end.
      std::fprintf(stderr, "%sroomradar: %s\n", isatty(STDERR_FILENO) != 0 ? "\n" : "", sentence.c_str());
    });
  ScanProgress progress(options, start);
  PrescanResult scanned = or_say_what_is_kept(start, [&] {
    const auto show = [&](const std::string& stage, const std::string& note) {
      if (stage == "track") last_frame_s = report.seconds();
      progress.show(stage, note);
    };
    return prescan(*start.source, config, report.times, show,
                   {start.checkpoints.get(), std::move(start.map)});
  });
  report.frames_read = scanned.counts.frames_read;
  report.frames_skipped = scanned.counts.frames_skipped;
  report.results.update(results_of(scanned));
  return scanned;
}

struct HeldOut {
  std::optional<HeldOutScore> score;  ///< unset: no frames were held out, or they were not compared
  std::string fault;                  ///< empty: none
};

HeldOut score_map(const PrescanOptions& options, FrameSource& source, const PrescanResult& scanned,
                  Report& report) {
  HeldOut held_out;
  if (options.hold_out <= 0) return held_out;
  // An extended map's last poses are this scan's.
  const std::vector<TimedPose> poses(scanned.map.trajectory.end() - scanned.counts.frames_tracked,
                                     scanned.map.trajectory.end());
  try {
    held_out.score = report.times.timed(
        "held_out", [&] { return score_held_out(source, scanned.map.mesh, poses, options.hold_out); });
    report.results["held_out"] = held_out_json(*held_out.score);
  } catch (const Error& error) {
    held_out.fault = error.what();
  }
  return held_out;
}

}  // namespace

int run(const PrescanOptions& options) {
  mmap_large_allocations();
  Report report;
  report.command = "prescan";
  report.source = options.source;
  report.settings = settings_of(options);
  PrescanConfig config = config_of(options);
  require_can_become_map(options.map, {options.report});
  require_writable(options.report);
  ScanStart start = start_scan(options);
  if (start.is_done) return report_held_already(options, report);
  const Interrupt interrupt;
  if (!start.is_live) Interrupt::say(kStops);
  const bool extends = start.map.has_value();
  if (extends) keep_settings_of_map(options, *start.map, config, report);
  announce_memory(*start.source, config, report);

  double last_frame_s = 0.0;
  const PrescanResult scanned = scan(options, config, start, report, last_frame_s);
  const bool was_stopped = scanned.counts.stopped_for_memory;
  const bool keep_frames = was_stopped && !start.spool.empty();
  if (extends && was_stopped) {
    if (start.checkpoints) finish(*start.checkpoints, keep_frames);
    write_report(report, options.report);
    throw Error(
        stopped_for_memory(options, keep_frames) + options.map +
        " is unchanged, because the rest could not be added later; with more memory it is added completely");
  }
  or_say_what_is_kept(start,
                      [&] { report.times.timed("save", [&] { save_map(options.map, scanned.map); }); });
  report.results["ready_after_s"] = report.seconds() - last_frame_s;

  const HeldOut held_out = score_map(options, *start.source, scanned, report);
  if (start.checkpoints) finish(*start.checkpoints, keep_frames);
  print_summary(options, scanned, held_out.score);
  print_holes(scanned.holes);
  write_report(report, options.report);
  if (!held_out.fault.empty())
    std::fprintf(stderr, "roomradar: %s: is saved; its held-out frames could not be compared with it: %s\n",
                 options.map.c_str(), held_out.fault.c_str());
  if (!was_stopped) return held_out.fault.empty() ? 0 : 1;
  throw Error(stopped_for_memory(options, keep_frames) + "the map of the " +
              std::to_string(scanned.counts.frames_fused) + " fused frames is saved and complete; " +
              (keep_frames
                   ? "with more memory the rest is included"
                   : "with a coarser --resolution or more memory the rest is included, from the beginning"));
}

}  // namespace roomradar
