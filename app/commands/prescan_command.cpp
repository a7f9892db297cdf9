// prescan_command.cpp: roomradar prescan: scans a room once and saves it as a map.
#include "app/commands/scan_and_play.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/apply_scan_quality.hpp"
#include "app/cli/input_lines.hpp"
#include "app/cli/interrupt.hpp"
#include "app/cli/report.hpp"
#include "app/cli/shell_line.hpp"
#include "app/evaluation/held_out.hpp"
#include "app/objects/kept_objects.hpp"
#include "app/objects/moved_supports.hpp"
#include "app/quality/quality_json.hpp"
#include "app/scan/controlled_source.hpp"
#include "app/scan/live/next_view.hpp"
#include "app/scan/prescan_report.hpp"
#include "app/scan/scan_end.hpp"
#include "app/scan/scan_progress.hpp"
#include "app/window/scan/scan_window.hpp"
#include "mapping/deskewed_source.hpp"
#include "mapping/history/visits.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/prescan.hpp"
#include "mapping/scan_memory.hpp"
#include "mapping/types/system/error.hpp"
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

nlohmann::json settings_of(const PrescanOptions& options) {
  nlohmann::json settings = {{"map", options.map}, {"poses", to_string(options.poses)}};
  settings.update(to_json(options.quality));
  if (!options.preset.empty()) settings["preset"] = options.preset;
  if (!options.presets.empty()) settings["presets"] = options.presets;
  if (options.up)
    settings["up"] = options.up->up_world ? to_json(*options.up->up_world) : nlohmann::json("camera");
  if (options.hold_out > 0) settings["hold_out"] = options.hold_out;
  if (options.max_fused != PrescanOptions{}.max_fused) settings["max_fused"] = options.max_fused;
  if (!options.texture) settings["texture"] = "off";
  if (options.max_memory_mb > 0.0) settings["max_memory_mb"] = options.max_memory_mb;
  if (!options.calibration.empty()) settings["calibration"] = options.calibration;
  if (options.frames) settings["frames"] = {options.frames->first, options.frames->last};
  add_to(settings, options.input);
  return settings;
}

/// Reports that the map already contains the recording to resume; returns the exit status.
/// @param channel  to the window; null: no window
int report_held_already(const PrescanOptions& options, ScanChannel* channel, Report& report) {
  const std::string sentence = options.map + ": already contains " + options.source +
                               "; there is nothing to resume (for another recording, name another map)";
  std::printf("%s\n", sentence.c_str());
  std::fflush(stdout);  // the window may stay open
  if (channel) channel->finish({sentence, std::make_shared<const Mesh>(load_map(options.map).mesh)});
  report.results["held_already"] = true;
  write_report(report, options.report);
  return 0;
}

/// Sets the resolution and the mesh's deviation to those of the map that is extended, with a message if they
/// differ from the requested ones. A deviation given as an option takes precedence, and the map keeps it.
void keep_settings_of_map(const PrescanOptions& options, SavedMap& map, PrescanConfig& config,
                          Report& report) {
  const bool is_asked_for = std::any_of(options.fixed.begin(), options.fixed.end(),
                                        [](const auto& field) { return field.first == "deviation_m"; });
  keep_settings_of(map, is_asked_for, config);
  report.settings["resolution_m"] = config.resolution_m;
  report.settings["deviation_m"] = nlohmann::json::parse(map.info.settings[kDeviationSetting]);
  if (config.resolution_m != options.quality.resolution_m ||
      config.surface.max_deviation_m != static_cast<float>(options.quality.deviation_m))
    std::fprintf(stderr, "%s: is extended, and keeps its cells of %g m and its --deviation of %g m\n",
                 options.map.c_str(), config.resolution_m,
                 static_cast<double>(config.surface.max_deviation_m));
}

struct TimedScan {
  PrescanResult scanned;
  double last_frame_s = 0.0;  ///< Report::seconds() when the last frame was tracked
};

/// Scans the room; the map to extend is moved from `start`. Errors say whether the scan can be resumed.
/// @param writer  saves parts of the map as soon as they are ready
TimedScan scan(const PrescanOptions& options, const PrescanConfig& config, ScanStart& start,
               ScanWindow& window, MapWriter& writer, Report& report) {
  if (start.checkpoints)
    start.checkpoints->tell_failure([](const std::string& sentence) {
      // On a terminal the progress line has no line end.
      std::fprintf(stderr, "%sroomradar: %s\n", isatty(STDERR_FILENO) != 0 ? "\n" : "", sentence.c_str());
    });
  const bool extends = start.map.has_value();
  ScanProgress progress(options, start, config, window);
  double last_frame_s = 0.0;
  PrescanResult scanned = or_say_what_is_kept(options, start, [&] {
    const auto show = [&](const std::string& stage, const std::string& note) {
      if (is_tracking(stage)) last_frame_s = report.seconds();
      progress.show(stage, note);
    };
    return prescan(*start.source, config, report.times, show,
                   {start.checkpoints.get(), std::move(start.map), window.view.get(), &writer});
  });
  report.frames_read = scanned.counts.frames_read;
  report.frames_skipped = scanned.counts.frames_skipped;
  report.results.update(results_of(scanned));
  const char* const command = extends           ? "prescan --resume"
                              : options.replace ? "prescan --replace"
                                                : "prescan";
  scanned.map.made = {command, without_folders(options.source), {}};
  return {std::move(scanned), last_frame_s};
}

/// Returns the poses of this scan's frames. An extended map has those of earlier scans before them.
std::vector<TimedPose> poses_of_scan(const PrescanResult& scanned) {
  const auto& poses = scanned.map.trajectory;
  return {poses.end() - scanned.counts.frames_tracked, poses.end()};
}

struct HeldOut {
  std::optional<HeldOutScore> score;  ///< unset: no frames were held out, or they were not compared
  std::string fault;                  ///< empty: none
};

HeldOut score_map(const PrescanOptions& options, FrameSource& source, const PrescanResult& scanned,
                  Report& report) {
  HeldOut held_out;
  if (options.hold_out <= 0) return held_out;
  const std::vector<TimedPose> poses = poses_of_scan(scanned);
  try {
    // The map is deskewed, so the frames that judge it must be, too.
    DeskewedSource deskewed(source, poses, scanned.counts.timing);
    held_out.score = report.times.timed(
        "held_out", [&] { return score_held_out(deskewed, scanned.map.mesh, poses, options.hold_out); });
    report.results["held_out"] = held_out_json(*held_out.score);
  } catch (const Error& error) {
    held_out.fault = error.what();
  }
  return held_out;
}

/// Returns the holes that are numbered in coverage.png and in the report.
std::vector<Hole> holes_inside(std::vector<Hole> holes) {
  std::erase_if(holes, [](const Hole& hole) { return !is_inside_scan(hole); });
  return holes;
}

/// Returns the sentence that the window shows at the end.
std::string outcome_of(const PrescanOptions& options, const PrescanResult& scanned) {
  return "The map is saved in " + options.map + ": " + std::to_string(scanned.counts.frames_tracked) +
         " of " + std::to_string(scanned.counts.frames_read) + " frames tracked, " +
         std::to_string(scanned.map.mesh.triangles.size()) + " triangles, " +
         std::to_string(holes_inside(scanned.holes).size()) +
         " holes inside the scan, numbered in the model.";
}

/// Returns the view that the window shows first: that of options.look_at.
std::optional<NextView> first_view_of(const PrescanOptions& options) {
  if (!options.look_at) return std::nullopt;
  return view_of(options.look_at->point_world, options.look_at->viewpoint_world, Eigen::Vector3d::UnitZ());
}

/// Says that objects go with the map that a scan replaces. A list that cannot be read counts as objects.
void announce_lost_objects(const PrescanOptions& options) {
  const std::filesystem::path folder = std::filesystem::path(options.map) / kMapObjectsFolder;
  std::string objects = "the objects";
  try {
    const std::size_t count = read_kept_objects(folder).size();
    if (count == 0) return;
    objects = std::to_string(count) + (count == 1 ? " object" : " objects");
  } catch (const Error&) {
  }
  std::fprintf(
      stderr,
      "roomradar: %s: this scan replaces the map; the present one stays as an earlier revision, without "
      "%s that stood in it; Ctrl-C now keeps both\n",
      options.map.c_str(), objects.c_str());
}

/// Throws Error if a scan without --resume and --replace would replace a map.
void require_replaceable(const PrescanOptions& options) {
  std::error_code ignored;
  if (options.resume || options.replace ||
      !std::filesystem::exists(std::filesystem::path(options.map) / kMapInfoFile, ignored))
    return;
  throw Error(
      options.map +
      ": is a map already. Extend it by this scan with --resume, replace it with --replace (it stays as an "
      "earlier revision, see `" +
      shell_line({"roomradar", "map", "log", options.map}) + "`), or name another map");
}

/// Moves the objects in the room that stood on something that was carried elsewhere since the map was made,
/// and says so. The objects are in the saved map.
void follow_moved_supports(const PrescanOptions& options, const StaticMap& before, const StaticMap& after) {
  const std::filesystem::path folder = std::filesystem::path(options.map) / kMapObjectsFolder;
  std::vector<KeptObject> objects = read_kept_objects(folder);
  const std::vector<SupportChange> changes = roomradar::follow_moved_supports(before, after, folder, objects);
  if (std::any_of(changes.begin(), changes.end(), [](const SupportChange& each) { return each.was_moved; }))
    write_kept_objects(folder, objects);
  for (const SupportChange& change : changes) {
    if (change.was_moved)
      std::printf("%s: moved by %.2f m and turned by %.0f degrees with what it stands on\n",
                  change.name.c_str(), change.moved_m, change.turned_deg);
    else
      std::printf("%s: what it stood on is gone; it falls in the next run\n", change.name.c_str());
  }
}

/// Returns the octree of the map before this scan if objects stand in the room; nullopt else.
std::optional<StaticMap> octree_under_objects(const PrescanOptions& options) {
  if (read_kept_objects(std::filesystem::path(options.map) / kMapObjectsFolder).empty()) return std::nullopt;
  return load_map_octree(options.map);
}

/// Scans and saves. Returns the exit status.
int scan_and_save(const PrescanOptions& options, ScanChannel* channel) {
  Report report;
  report.command = "prescan";
  report.source = options.source;
  report.settings = settings_of(options);
  PrescanConfig config = prescan_config_of(options);
  ScanStart start = start_scan(options);
  if (start.is_done) return report_held_already(options, channel, report);
  InputLines lines(*start.input, start.source ? start.source->name() : options.source);
  lines.say();
  const Interrupt interrupt;
  if (!start.is_live) Interrupt::say(kStopsWithoutMap);
  if (start.checkpoints) say_at_once_how_to_resume(options);
  const bool extends = start.map.has_value();
  if (extends)
    keep_settings_of_map(options, *start.map, config, report);
  else
    announce_lost_objects(options);
  announce_memory(*start.source, config, report);
  ScanWindow window{channel};
  if (channel) {
    start.source = controlled(std::move(start.source), *channel);
    const std::filesystem::path folder = std::filesystem::absolute(options.map).parent_path();
    window.view =
        std::make_unique<ScanView>(*channel, config.max_memory_bytes,
                                   start.spool.empty() ? folder : start.spool, first_view_of(options));
  }

  MapWriter writer(options.map);
  const TimedScan timed = scan(options, config, start, window, writer, report);
  const PrescanResult& scanned = timed.scanned;
  const bool was_stopped = scanned.counts.stopped_for_memory;
  const bool keep_frames = was_stopped && !start.spool.empty();
  if (extends && was_stopped) {
    if (start.checkpoints) finish(*start.checkpoints, keep_frames);
    write_report(report, options.report);
    fail_to_extend(options, keep_frames);
  }
  lines.say();
  report.results["input"] = to_json(start.input->decisions());
  const std::optional<StaticMap> before = extends ? octree_under_objects(options) : std::nullopt;
  or_say_what_is_kept(options, start,
                      [&] { report.times.timed("save", [&] { writer.commit(scanned.map); }); });
  if (before)
    report.times.timed("objects",
                       [&] { follow_moved_supports(options, *before, scanned.map.octree.load()); });
  report.results["ready_after_s"] = report.seconds() - timed.last_frame_s;

  Interrupt::say_when_ended("");  // the map is saved
  if (!options.trajectory.empty()) write_trajectory(options.trajectory, poses_of_scan(scanned));
  const HeldOut held_out = score_map(options, *start.source, scanned, report);
  if (start.checkpoints) finish(*start.checkpoints, keep_frames);
  print_summary(options, scanned, held_out.score);
  print_holes(scanned.holes);
  std::fflush(stdout);  // the window may stay open
  if (channel)
    channel->finish({outcome_of(options, scanned), std::make_shared<const Mesh>(scanned.map.mesh),
                     numbered(holes_inside(scanned.holes))});
  write_report(report, options.report);
  if (!held_out.fault.empty())
    std::fprintf(stderr, "roomradar: %s: is saved; its held-out frames could not be compared with it: %s\n",
                 options.map.c_str(), held_out.fault.c_str());
  if (was_stopped) say_stopped_for_memory(options, scanned.counts.frames_fused, keep_frames);
  return held_out.fault.empty() ? 0 : 1;
}

void require_can_save(const PrescanOptions& options) {
  mmap_large_allocations();
  require_replaceable(options);
  require_can_become_map(options.map, {options.report, options.trajectory});
  require_writable(options.report);
  require_writable(options.trajectory);
}

}  // namespace

int scan(const PrescanOptions& options) {
  require_can_save(options);
  return scan_and_save(options, nullptr);
}

ScanWindowResult scan_in_window(const PrescanOptions& options) {
  require_can_save(options);
  return run_in_scan_window(
      "roomradar scan - " + options.source, options.ui_scale, options.lost_signal, [&](ScanChannel& channel) {
        try {
          return scan_and_save(options, &channel);
        } catch (const ScanDiscarded&) {
          std::fprintf(stderr, "\nroomradar: the scan was discarded; no map was saved\n");
          return 1;
        }
      });
}

}  // namespace roomradar
