// unfinished_scan.cpp: decides how a prescan begins from the existing map and the interrupted scan in
// MAP.unfinished.
#include "app/scan/unfinished_scan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/interrupt.hpp"
#include "app/cli/open_source.hpp"
#include "app/cli/shell_line.hpp"
#include "app/sources/recordings/spooled_source.hpp"
#include "mapping/history/visits.hpp"
#include "mapping/scan_memory.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNewMap = "a new map";
constexpr const char* kSpool = "spool";

fs::path unfinished_beside(const fs::path& map) {
  return map.parent_path() / (map.filename().string() + ".unfinished");
}

bool is_unfinished(const fs::path& folder) { return fs::exists(folder / "work.json"); }

void require_no_live_scan(const PrescanOptions& options, const fs::path& folder) {
  if (!SpooledSource::has_frames(folder / kSpool)) return;
  if (is_unfinished(folder))
    Checkpoints(folder, {}, 0.0).ensure_folder();  // throws if another process works
                                                   // on it
  throw Error(folder.string() +
              ": holds an interrupted live scan; continue it with --resume, or delete the folder to start "
              "again:\n  " +
              command_to_resume(options));
}

/// Throws Error if the cap is too low to begin the scan at all.
/// @param later_bytes  needed later in any case
void require_memory_to_begin(double cap_mb, double later_bytes = 0.0) {
  constexpr double kMB = 1e6, kToTrack_mb = 60.0;
  constexpr double kSpare_mb = 8.0;  // processes differ in how much of their libraries is in memory
  const double least_mb = (static_cast<double>(resident_bytes()) + later_bytes) / kMB + kToTrack_mb;
  if (!(cap_mb > 0.0) || least_mb <= cap_mb) return;
  throw Error("--max-memory " + std::to_string(std::llround(cap_mb)) +
              ": is too little to begin with; give at least " +
              std::to_string(std::llround(std::ceil(least_mb + kSpare_mb))));
}

/// Deletes an interrupted scan that is not resumed; its source can be read again.
void give_up_unfinished(const fs::path& folder) {
  if (!fs::exists(folder)) return;
  Checkpoints unfinished(folder, {}, 0.0);
  unfinished.ensure_folder();  // throws if another process works on it
  std::fprintf(stderr, "%s: an interrupted scan is discarded; --resume would have continued it\n",
               folder.c_str());
  unfinished.remove();
}

bool is_to_extend(bool resume, const fs::path& folder, const fs::path& map) {
  if (!resume) return false;
  if (is_unfinished(folder)) return identity_of(folder)["into"] != kNewMap;
  if (fs::exists(map / "map.json")) return true;
  if (fs::exists(map / "building.json"))
    throw Error(
        map.string() +
        ": is the map of a building; `roomradar building` adds recordings to it, and prescan takes the "
        "map of one room");
  throw Error(map.string() + ": there is nothing to resume: no map, and no interrupted scan (" +
              folder.string() + "); leave out --resume to begin a new map");
}

/// Returns true if the map already contains a recording: the scan to resume was complete.
bool holds(const MapInfo& map, const FrameSource& source) {
  const std::string id = source_id_of(source.name());
  return std::any_of(map.sessions.begin(), map.sessions.end(),
                     [&](const MapSession& session) { return session.source_id == id; });
}

/// Opens the source, or leaves it null if all its frames are stored, or if it is a disconnected device with
/// stored frames to resume from.
void open_or_say(const PrescanOptions& options, const fs::path& folder, ScanStart& start) {
  if (SpooledSource::has_end(folder / kSpool)) return;
  SourceOptions source_options = source_options_of(options.input);
  source_options.keep_all = true;
  source_options.cache_simulated = true;
  source_options.questions = Questions::kDepth;
  source_options.input = start.input;
  try {
    start.source = open_source(options.source, options.frames, options.calibration, source_options);
  } catch (const Error& fault) {
    const bool has_its_frames = options.resume && SpooledSource::has_frames(folder / kSpool) &&
                                identity_of(folder)["source"] == options.source;
    if (!has_its_frames) throw;
    std::fprintf(
        stderr,
        "%s. The map is made from the frames scanned before; --resume extends it once the device is back\n",
        fault.what());
  }
}

/// Ends a scan whose recording is in the map already; deletes an interrupted scan beside the map. Throws
/// Error if the recording is in the map only in part.
void end_held_already(const fs::path& map, const fs::path& folder, ScanStart& start) {
  if (fs::exists(folder)) {
    Checkpoints unfinished(folder, {}, 0.0);
    unfinished.ensure_folder();  // throws if another process works on it
    unfinished.remove();
  }
  const auto stopped = start.map->info.settings.find(kStoppedSetting);
  if (stopped != start.map->info.settings.end() && stopped->second == without_folders(start.source->name()))
    throw Error(map.string() + ": was stopped by --max-memory before all of " + stopped->second +
                " was in it; scan it again with more memory or a coarser --resolution: without --resume, "
                "or as another map");
  start.is_done = true;
}

/// Returns the facts by which a checkpoint is known to belong to the same scan.
/// @param recording  source that can be rewound; null: a live source
/// @param into  checksum of the map to extend, or kNewMap
std::map<std::string, std::string> identity_for(const PrescanOptions& options, const FrameSource* recording,
                                                const std::string& into) {
  const fs::path calibration = calibration_for(options.source, options.calibration);
  std::map<std::string, std::string> identity{
      {"source", recording ? recording->name() : options.source},
      {"resolution", format_fixed(options.quality.resolution_m, 6)},
      {"tracking-px", std::to_string(options.quality.tracking_px)},
      {"fuse-every", std::to_string(options.quality.fuse_every)},
      {"poses", std::string(to_string(options.poses))},
      {"frames", options.frames
                     ? std::to_string(options.frames->first) + ":" + std::to_string(options.frames->last)
                     : "all"},
      {"hold-out", std::to_string(options.hold_out)},
      {"max-fused", std::to_string(options.max_fused)},
      {"calibration", calibration.empty() ? "none" : sha256_of_file(calibration)},
      {"into", into}};
  if (const std::string words = words_of(options.input); !words.empty()) identity["input"] = words;
  if (recording) identity["length"] = std::to_string(recording->frame_count().value_or(-1));
  return identity;
}

/// Returns the checkpoints of a new or interrupted scan. Throws Error if they belong to another scan, or if
/// another process works on them.
std::unique_ptr<Checkpoints> open_checkpoints(const fs::path& folder, double every_s,
                                              const std::map<std::string, std::string>& identity) {
  auto checkpoints = std::make_unique<Checkpoints>(
      folder, identity, every_s > 0.0 ? every_s : std::numeric_limits<double>::infinity());
  checkpoints->ensure_folder();  // from now on no other process can begin this map
  checkpoints->require_same_work();
  return checkpoints;
}

}  // namespace

std::string command_to_resume(const PrescanOptions& options) {
  std::vector<std::string> words = options.line;
  if (words.empty()) {
    words = {"roomradar", "prescan", options.source, "--map", options.map};
    if (!options.calibration.empty()) words.insert(words.end(), {"--calibration", options.calibration});
    if (options.window) words.emplace_back("--window");
  }
  if (std::find(words.begin(), words.end(), "--resume") == words.end()) words.emplace_back("--resume");
  return shell_line(words);
}

ScanStart start_scan(const PrescanOptions& options) {
  ScanStart start;
  const fs::path map = tidy_map_name(options.map);
  const fs::path folder = unfinished_beside(map);
  require_checkpoints_only(folder, kSpool);
  require_checkpoints_only(done_beside(folder), kSpool);
  if (!options.resume) require_no_live_scan(options, folder);
  const bool extend = is_to_extend(options.resume, folder, map);
  std::error_code ignored;
  fs::remove_all(done_beside(folder), ignored);

  const fs::path spool = folder / kSpool;
  open_or_say(options, folder, start);
  const bool spooled = !start.source;  // all frames are stored, or the device is gone
  if (!extend) require_memory_to_begin(options.max_memory_mb);
  if (!options.resume) give_up_unfinished(folder);  // only now that the source is open
  const bool live = spooled || !start.source->rewind();
  start.is_live = live && !spooled;
  if (start.is_live) start.source = ended_by_interrupt(std::move(start.source));
  const std::string into = extend ? sha256_of_file(map / "map.json") : kNewMap;
  if (extend) {
    start.map = load_map(map);
    require_memory_to_begin(
        options.max_memory_mb,
        memory_after_fusion(static_cast<double>(start.map->octree.load().memory_bytes())));
  }
  if (extend && !live && holds(start.map->info, *start.source) &&
      (!is_unfinished(folder) || identity_of(folder)["into"] != into)) {
    end_held_already(map, folder, start);
    return start;
  }
  // A scan to resume is in the checkpoints, even if no further ones are requested.
  if (options.checkpoint_every_s > 0.0 || spooled || is_unfinished(folder))
    start.checkpoints = open_checkpoints(folder, options.checkpoint_every_s,
                                         identity_for(options, live ? nullptr : start.source.get(), into));
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
