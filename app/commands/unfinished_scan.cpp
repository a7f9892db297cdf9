// unfinished_scan.cpp: what lies at the map's place and beside it decides how a prescan begins.
#include "app/commands/unfinished_scan.hpp"

#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include "app/cli/interrupt.hpp"
#include "app/cli/open_source.hpp"
#include "app/sources/recordings/spooled_source.hpp"
#include "mapping/octree/memory_use.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNewMap = "a new map";
constexpr const char* kSpool = "spool";

fs::path unfinished_beside(const fs::path& map) {
  return map.parent_path() / (map.filename().string() + ".unfinished");
}

bool is_unfinished(const fs::path& folder) { return fs::exists(folder / "work.json"); }

void require_no_live_scan(const fs::path& folder) {
  if (!SpooledSource::has_frames(folder / kSpool)) return;
  if (is_unfinished(folder)) Checkpoints(folder, {}, 0.0).ensure_folder();  // nobody is at work on it
  throw Error(folder.string() +
              ": holds a live scan that was cut off; go on with it by --resume, or delete "
              "the folder to begin anew");
}

/// Throws Error if the scan cannot even begin under the cap.
/// @param later_bytes  that are needed whatever is scanned
void require_memory_to_begin(double cap_mb, double later_bytes = 0.0) {
  constexpr double kMB = 1e6, kToTrack_mb = 60.0;
  constexpr double kSpare_mb = 8.0;  // processes differ in how much of their libraries is in memory
  const double least_mb = (static_cast<double>(resident_bytes()) + later_bytes) / kMB + kToTrack_mb;
  if (!(cap_mb > 0.0) || least_mb <= cap_mb) return;
  throw Error("--max-memory " + std::to_string(std::llround(cap_mb)) +
              ": is too little to begin with; give at least " +
              std::to_string(std::llround(std::ceil(least_mb + kSpare_mb))));
}

/// A scan that was cut off, and is not to be resumed: what can be read again may go.
void give_up_unfinished(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  Checkpoints unfinished(folder, {}, 0.0);
  unfinished.ensure_folder();  // nobody else is at work on it
  std::fprintf(stderr, "%s: a scan that was cut off is given up; --resume would have gone on with it\n",
               folder.c_str());
  unfinished.remove();
}

bool is_to_extend(bool resume, const fs::path& folder, const fs::path& map) {
  if (!resume) return false;
  if (is_unfinished(folder)) return identity_of(folder)["into"] != kNewMap;
  if (fs::exists(map / "map.json")) return true;
  throw Error(map.string() + ": there is nothing to resume: no map, and no scan that was cut off (" +
              folder.string() + "); leave --resume away to begin a new map");
}

/// Whether a map has a recording's frames already: then the scan to be resumed had come to its end.
bool holds(const MapInfo& map, const FrameSource& source) {
  return ("; " + map.source + "; ").find("; " + source.name() + "; ") != std::string::npos;
}

/// The source; null where it is a device that is not there any more, but frames of it are, to be resumed
/// with.
std::unique_ptr<FrameSource> open_or_say(const PrescanCommand& command, const SourceOptions& options,
                                         const fs::path& folder) {
  try {
    return open_source(command.source, command.frames, command.calibration, options);
  } catch (const Error& fault) {
    const bool has_its_frames = command.resume && SpooledSource::has_frames(folder / kSpool) &&
                                identity_of(folder)["source"] == command.source;
    if (!has_its_frames) throw;
    std::fprintf(
        stderr,
        "%s. The map is made of what was scanned before; --resume adds to it once the device is back\n",
        fault.what());
    return nullptr;
  }
}

}  // namespace

ScanStart start_scan(const PrescanCommand& command) {
  ScanStart start;
  const fs::path map = tidy_map_name(command.map);
  const fs::path folder = unfinished_beside(map);
  require_checkpoints_only(folder, kSpool);
  require_checkpoints_only(done_beside(folder), kSpool);
  if (!command.resume) require_no_live_scan(folder);
  const bool extend = is_to_extend(command.resume, folder, map);
  std::error_code ignored;
  fs::remove_all(done_beside(folder), ignored);

  const fs::path spool = folder / kSpool;
  SourceOptions options;
  options.keep_all = true;
  if (!SpooledSource::has_end(spool)) start.source = open_or_say(command, options, folder);
  const bool spooled = !start.source;  // all that there is: the device is not needed any more, or is gone
  if (!extend) require_memory_to_begin(command.max_memory_mb);
  if (!command.resume) give_up_unfinished(folder);  // what follows it is there
  const bool live = spooled || !start.source->rewind();
  start.is_live = live && !spooled;
  if (start.is_live) start.source = ended_by_interrupt(std::move(start.source));
  const std::string into = extend ? sha256_of_file(map / "map.json") : kNewMap;
  if (extend) {
    start.map = load_map(map);
    require_memory_to_begin(command.max_memory_mb,
                            kSurfaceMemory * static_cast<double>(start.map->octree.memory_bytes()));
  }
  if (extend && !live && holds(start.map->info, *start.source) &&
      (!is_unfinished(folder) || identity_of(folder)["into"] != into)) {
    if (fs::exists(folder)) {
      Checkpoints unfinished(folder, {}, 0.0);
      unfinished.ensure_folder();  // nobody else is at work on it
      unfinished.remove();
    }
    const auto stopped = start.map->info.settings.find(kStoppedSetting);
    if (stopped != start.map->info.settings.end() && stopped->second == start.source->name())
      throw Error(
          map.string() + ": was stopped by --max-memory before all of " + stopped->second +
          " was in it; scan that anew with more memory or a coarser --resolution: without --resume, or "
          "as another map");
    start.is_done = true;
    return start;
  }
  // What is to be resumed is in the checkpoints, whether or not there are to be more of them.
  if (command.checkpoint_every_s > 0.0 || spooled || is_unfinished(folder)) {
    const double every_s = command.checkpoint_every_s > 0.0 ? command.checkpoint_every_s
                                                            : std::numeric_limits<double>::infinity();
    const fs::path calibration = calibration_for(command.source, command.calibration);
    std::map<std::string, std::string> identity{
        {"source", live ? command.source : start.source->name()},
        {"resolution", std::to_string(command.quality.resolution_m)},
        {"tracking-px", std::to_string(command.quality.tracking_px)},
        {"fuse-every", std::to_string(command.quality.fuse_every)},
        {"poses", std::string(to_string(command.poses))},
        {"frames", command.frames
                       ? std::to_string(command.frames->first) + ":" + std::to_string(command.frames->last)
                       : "all"},
        {"hold-out", std::to_string(command.hold_out)},
        {"calibration", calibration.empty() ? "none" : sha256_of_file(calibration)},
        {"into", into}};
    if (!live) identity["length"] = std::to_string(start.source->frame_count().value_or(-1));
    start.checkpoints = std::make_unique<Checkpoints>(folder, identity, every_s);
    start.checkpoints->ensure_folder();  // nobody else may begin this map, from now on
    start.checkpoints->require_same_work();
  }
  if (live && start.checkpoints) start.spool = spool;
  if (spooled) {
    start.source = SpooledSource::again(spool);
  } else if (!start.spool.empty()) {
    start.source = SpooledSource::kept(std::move(start.source), spool);
  } else {
    start.source = make_rewindable(std::move(start.source));
  }
  return start;
}

}  // namespace roomradar
