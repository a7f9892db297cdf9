// opened_run.cpp: opens the map, source and outputs of a run. The order of the steps decides which error is
// reported first.
#include "app/run/opened_run.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <future>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "app/cli/open_source.hpp"
#include "app/cli/options/object_options.hpp"
#include "app/cli/options/run_options.hpp"
#include "app/objects/kept_objects.hpp"
#include "app/objects/object_file.hpp"
#include "app/objects/object_model.hpp"
#include "app/quality/quality_json.hpp"
#include "app/session/apply_quality.hpp"
#include "app/session/script/script.hpp"
#include "app/session/script/session_events.hpp"
#include "app/session/tiles/tile_window.hpp"
#include "mapping/building/building_map.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/odometry/up_direction.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/process_memory.hpp"

namespace roomradar {
namespace {

// ---- the script of a run without --script ----

constexpr double kDropHeight_m = 0.05;  // above a point that the user gave

/// Returns true if an object of the script has this name.
bool is_taken(const Script& script, const std::string& name) {
  return std::any_of(script.events.begin(), script.events.end(),
                     [&](const ScriptEvent& event) { return object_of(event.action) == name; });
}

std::string free_name(const Script& script, const ObjectOption& object) {
  const std::string stem = object_name(object.source.mesh);
  std::string name = stem;
  for (int number = 2; is_taken(script, name); ++number) name = stem + std::to_string(number);
  return name;
}

/// Adds events that add the objects and drop each of them. An object is dropped from 5 cm above its given
/// point, or above a level surface in view if no point is given. A single object is named kOnlyObject unless
/// an object of the script has that name; others are named after their files.
void drop_objects(const std::vector<ObjectOption>& objects, Script& script) {
  for (const ObjectOption& object : objects) {
    const bool is_only = objects.size() == 1 && !is_taken(script, kOnlyObject);
    const std::string name = is_only ? kOnlyObject : free_name(script, object);
    DropObject drop{.name = name, .position_world = object.at_world};
    if (object.at_world) drop.height_m = kDropHeight_m;
    script.events.push_back({.action = AddObject{name, object.source, object.material}, .frame = 0});
    script.events.push_back({.action = drop, .frame = 0});
  }
}

// ---- the objects that stay in the room ----

/// Returns the folder in which the run keeps its objects, which is made if it is the map's; empty: they are not
/// kept.
std::filesystem::path open_objects_folder(const RunOptions& options) {
  if (options.kept_objects == "none" || is_session_folder(options.source)) return {};
  if (options.kept_objects != "keep") return options.kept_objects;
  if (is_building(options.map)) return {};
  std::filesystem::path folder = std::filesystem::path(options.map) / kMapObjectsFolder;
  // Made before the map is opened: its folder then stays the same during the run, see folder_version().
  std::error_code unwritable;
  if (std::filesystem::exists(std::filesystem::path(options.map) / kMapInfoFile, unwritable))
    std::filesystem::create_directory(folder, unwritable);
  return folder;
}

/// Returns events that put the kept objects where they stood. Leaves out those whose name an object of
/// `given` has.
Script stand_objects(const std::filesystem::path& folder, const Script& given) {
  Script script;
  std::string names, replaced;
  for (const KeptObject& object : read_kept_objects(folder)) {
    std::string& list = is_taken(given, object.name) ? replaced : names;
    list += (list.empty() ? "" : ", ") + object.name;
    if (&list == &replaced) continue;
    script.events.push_back(
        {.action = AddObject{object.name, {.mesh = (folder / object.model).string()}, object.material},
         .frame = 0});
    script.events.push_back({.action = StandObject{object.name, object.T_world_object.translation(),
                                                   Eigen::Quaterniond(object.T_world_object.linear())},
                             .frame = 0});
  }
  if (!names.empty()) std::fprintf(stderr, "objects kept in the room: %s\n", names.c_str());
  if (!replaced.empty())
    std::fprintf(stderr, "replaced by the script's objects of the same name: %s\n", replaced.c_str());
  return script;
}

// ---- the map of a building ----

struct OpenedBuilding {
  SavedMap map;  ///< keyframes and bounds; surface and octree are empty
  TileWindowConfig tiles;
};

constexpr double kMB = 1e6;
constexpr double kKeyframesPart = 0.2;  // of the memory limit

void require_possible_in_building(const RunOptions& options, const Script& script) {
  const auto refuse = [&](const std::string& option, const char* why) {
    throw Error(option + ": " + options.map + " is a building, and " + why);
  };
  constexpr const char* kRoomsOnly = "changes can be committed to the map of a room only";
  if (options.commit_after_s) refuse("--commit-changes", kRoomsOnly);
  if (!options.save_map.empty()) refuse("--save-map", kRoomsOnly);
  if (has<CommitChanges>(script)) refuse("commit event", kRoomsOnly);
  if (options.poses == PoseOrigin::kRecorded)
    refuse("--poses recorded", "its world is not that of a recording; leave the option out");
}

/// Opens the building of options.map. With options.max_memory_mb, keyframes take at most a fifth of it.
/// Throws Error naming the file and the fault if a file is missing or damaged. Also throws Error if the run's
/// options or its script require the map of a room: for committed changes or recorded poses.
OpenedBuilding open_building(const RunOptions& options, const Script& script) {
  require_possible_in_building(options, script);
  OpenedBuilding opened;
  opened.tiles.folder = options.map;
  opened.tiles.building = read_building(options.map);
  opened.tiles.choice.has_unknown = options.unknown_is_solid;
  opened.tiles.max_process_bytes = static_cast<std::size_t>(kMB * options.max_memory_mb);
  const BuildingInfo& building = opened.tiles.building;
  if (building.tiles.empty()) throw Error(options.map + ": has no tiles; was any recording placed?");
  if (options.unknown_is_solid &&
      std::any_of(building.tiles.begin(), building.tiles.end(),
                  [](const BuildingTile& tile) { return tile.unknown.name.empty(); }))
    throw Error(
        options.map +
        ": has no frontier of unknown space, since an earlier version made it; run `roomradar building` "
        "again with the same recordings, or add --unknown free");
  mmap_large_allocations();  // tiles come and go: their memory goes back to the system

  const double keyframes_mb = kKeyframesPart * options.max_memory_mb;
  opened.map.keyframe_database =
      load_building_keyframes(building, options.map, static_cast<std::size_t>(kMB * keyframes_mb));
  release_unused_memory();
  MapInfo& info = opened.map.info;
  info.source = options.map;
  info.up_source = "building";
  info.resolution_m = building.grid.resolution_m;
  info.keyframes = opened.map.keyframe_database.load().keyframes.size();
  for (const BuildingTile& tile : building.tiles) {
    info.triangles += static_cast<std::uint64_t>(std::max<std::int64_t>(tile.triangles, 0));
    info.counts.known_world.extend(tile.surface_world);
  }
  return opened;
}

// ---- the run ----

constexpr std::size_t kLargeFile_bytes = 4U << 20U;  // larger than a frame's images

/// Returns the objects as given; a plain text if there is one.
nlohmann::json object_texts(const RunOptions& options) {
  nlohmann::json texts = nlohmann::json::array();
  for (const ObjectOption& object : options.objects) texts.push_back(object.text);
  return texts.size() == 1 ? texts[0] : texts;
}

nlohmann::json settings_of(const RunOptions& options) {
  nlohmann::json settings = {{"map", options.map},
                             {"poses", to_string(options.poses)},
                             {"object", object_texts(options)},
                             {"script", options.script},
                             {"objects", options.kept_objects},
                             {"surfaces", to_string(options.surfaces)},
                             {"unknown", options.unknown_is_solid ? "solid" : "free"},
                             {"at_end", to_string(options.at_end)},
                             {"window", options.window},
                             {"record_session", options.record_session},
                             {"save_map", options.save_map}};
  settings.update(to_json(options.quality));
  if (!options.preset.empty()) settings["preset"] = options.preset;
  if (!options.presets.empty()) settings["presets"] = options.presets;
  if (options.max_memory_mb > 0.0) settings["max_memory_mb"] = options.max_memory_mb;
  if (options.budget_ms) settings["budget_ms"] = *options.budget_ms;
  if (options.commit_after_s) settings["commit_s"] = *options.commit_after_s;
  if (!options.calibration.empty()) settings["calibration"] = options.calibration;
  if (options.frames) settings["frames"] = {options.frames->first, options.frames->last};
  return settings;
}

/// Prints the events that wait for an event above them, because they are due before it.
void say_what_waits(const Script& script, const std::string& path) {
  std::int64_t latest_frame = 0;
  double latest_s = 0.0;
  for (const ScriptEvent& event : script.events) {
    if (event.frame.value_or(latest_frame) < latest_frame || event.time_s.value_or(latest_s) < latest_s)
      std::fprintf(stderr, "roomradar: %s:%d: is due before an event above it, and waits for that\n",
                   path.c_str(), event.line);
    latest_frame = std::max(latest_frame, event.frame.value_or(0));
    latest_s = std::max(latest_s, event.time_s.value_or(0.0));
  }
}

/// Returns the given script, or one that drops the given objects; before it, the events of the objects that
/// stay in the room.
/// @param kept  folder of these objects; empty: none
Script script_of(const RunOptions& options, const std::filesystem::path& kept) {
  Script script;
  if (!options.script.empty())
    script =
        is_session_events(options.script) ? read_session_events(options.script) : read_script(options.script);
  if (!kept.empty()) {
    const Script standing = stand_objects(kept, script);
    script.events.insert(script.events.begin(), standing.events.begin(), standing.events.end());
  }
  const bool is_default = options.given_objects.texts.empty();  // a teapot, for a room without objects
  if (options.script.empty() && (script.events.empty() || !is_default)) drop_objects(options.objects, script);
  say_what_waits(script, options.script);
  for (ScriptEvent& event : script.events)
    if (auto* set = std::get_if<SetQuality>(&event.action)) set_fields(set->quality, options.fixed);
  return script;
}

void require_can_save_map(const RunOptions& options, const Script& script) {
  if (options.save_map.empty() || is_building(options.map)) return;  // a building refuses it, see open_map()
  if (!options.commit_after_s && !has<CommitChanges>(script))
    throw Error(
        "--save-map " + options.save_map +
        ": nothing would change in the map; add --commit-changes SECONDS, or a commit event to the script");
  require_can_become_map(options.save_map,
                         {options.report, options.frames_csv, options.trajectory, options.stream,
                          options.video, options.pictures, options.record_session});
}

void require_one_quality(const RunOptions& options, const Script& script) {
  if (!has<SetQuality>(script)) return;
  if (!options.preset.empty())
    throw Error(
        "--preset: the script or the session has quality events, which set everything that they do not name "
        "to its default, not to the preset's value; leave out one of them");
  if (options.budget_ms)
    throw Error(
        "--budget-ms: the script or the session also has quality events, and each would undo the "
        "other; leave out one of them");
}

void say_if_up_is_not_known(const MapInfo& info, const std::string& folder) {
  if (info.up_source != to_string(UpSource::kNone)) return;
  std::fprintf(stderr,
               "roomradar: %s: the up direction was not known when the room was scanned; objects fall "
               "downwards in its first camera's view. Scan it again with --up\n",
               folder.c_str());
}

/// Opens the source, and the recorded results if the source is a session.
/// @param check  set if the source is a session
std::unique_ptr<FrameSource> open_frames(OpenedRun& run, std::optional<ReplayCheck>& check) {
  const RunOptions& options = run.options;
  if (options.poses == PoseOrigin::kRecorded)
    require_recorded_world(run.map.info, options.map, options.source);
  SourceOptions source_options = source_options_of(options.input);
  // Poses that are not used need not be compared with depth, which takes time before the first picture.
  if (options.poses != PoseOrigin::kTracked) source_options.questions = Questions::kDepth;
  source_options.input = run.input;
  std::unique_ptr<FrameSource> opened =
      open_source(options.source, options.frames, options.calibration, source_options);
  run.input_lines.emplace(*run.input, opened->name());
  run.input_lines->say();
  run.is_live = !opened->rewind();  // frame_count() would not tell: with --frames a device has one too
  if (is_session_folder(options.source)) {
    run.is_replay = true;
    check.emplace(options.source);
    if (const std::string fault = map_difference(options.source, run.map.info); !fault.empty())
      std::fprintf(stderr, "roomradar: %s\n", fault.c_str());
  }
  // A session that was cut off has no quit event: it is replayed as far as it has results.
  if (check && !has<Quit>(run.script)) run.last_frame = check->last_frame();
  run.interrupt.emplace();
  return opened;
}

void open_budget(OpenedRun& run, bool has_picture) {
  const RunOptions& options = run.options;
  if (!options.budget_ms) return;
  const std::filesystem::path path = presets_file(options.presets);
  std::vector<FrontStep> front = front_for(read_presets(path), options.quality, options.fixed);
  if (front.size() < 2)
    std::fprintf(stderr,
                 "roomradar: %s has no setting faster than the requested one, so --budget-ms has no effect\n",
                 path.c_str());
  run.budget = std::make_unique<RunBudget>(std::move(front), *options.budget_ms, has_picture);
}

bool makes_picture(const RunOptions& options, bool has_window) {
  return has_window || !options.video.empty() || !options.pictures.empty();
}

/// @param tiles  set if the map is a building
SessionConfig config_of(const OpenedRun& run, bool has_picture, std::optional<TileWindowConfig> tiles) {
  const RunOptions& options = run.options;
  SessionConfig config;
  config.poses = options.poses;
  config.scene.surfaces = options.surfaces;
  apply(options.quality, config);
  config.make_picture = has_picture;
  config.measure_penetration = !options.report.empty();
  if (run.budget)
    config.watch = [budget = run.budget.get()](FramePart part, const FrameLoad& load) {
      return budget->before(part, load);
    };
  config.tiles = std::move(tiles);
  // A live run does not wait, unless it is recorded and must be reproducible.
  const bool waits = !run.is_live || !options.record_session.empty();
  if (config.tiles) config.tiles->wait = waits;
  if (options.commit_after_s || has<CommitChanges>(run.script)) {
    config.map_updates.emplace();
    config.map_updates->after_s = options.commit_after_s;
    config.map_updates->surface = surface_config_of(run.map.info);
    config.map_updates->wait = waits;
  }
  return config;
}

void make_unknown_solid(Session& session, StageTimes& times) {
  const auto start = std::chrono::steady_clock::now();
  session.make_unknown_solid(times);
  if (session.unknown() != nullptr && session.unknown()->memory_bytes > 0)  // not from the map's folder
    std::fprintf(
        stderr,
        "unknown space: the map was saved without its frontier; %zu triangles, extracted in %.1f s with "
        "%.0f MB\n",
        session.unknown()->mesh_world.triangles.size(), ms_since(start) / 1e3,
        static_cast<double>(session.unknown()->memory_bytes) / 1e6);
}

constexpr double kLarge_mb = 10.0;  // a model of this size is prepared in about 5 s

/// Returns the size of a model's file, MB; 0 for the built-in teapot.
double model_mb(const AddObject& add) {
  std::error_code failed;
  const std::uintmax_t bytes = std::filesystem::file_size(add.source.mesh, failed);
  return failed ? 0.0 : static_cast<double>(bytes) / 1e6;
}

/// Prepares the run's first object on another thread, without its levels of detail, which are computed while
/// the first frame is processed. Returns an empty future if there is no object, or its model is large.
std::future<ObjectParts> first_object_of(const Script& script) {
  for (const ScriptEvent& event : script.events) {
    const auto* const add = std::get_if<AddObject>(&event.action);
    if (add == nullptr) continue;
    if (model_mb(*add) > kLarge_mb) return {};
    return std::async(std::launch::async, [add = *add] {
      return object_parts_without_levels(add.name, object_model(add.source));
    });
  }
  return {};
}

/// Adds an object. A large model is announced, because preparing its levels of detail takes up to minutes.
/// @param event  its action is `add`
/// @param script  file in which errors are located; unused if the event is not from a file
/// @param prepared  the object's parts; empty: not prepared
void add_object(Session& session, const ScriptEvent& event, const AddObject& add, const std::string& script,
                std::future<ObjectParts> prepared) {
  const double size_mb = model_mb(add);
  const bool is_announced = size_mb > kLarge_mb;
  if (is_announced)
    std::fprintf(stderr, "%s: %.0f MB, preparing its levels of detail ...\n", add.source.mesh.c_str(),
                 size_mb);
  const auto start = std::chrono::steady_clock::now();
  try {
    if (prepared.valid())
      add_object(session, add, event.line, prepared.get());
    else
      apply(session, event);
  } catch (const Error& fault) {
    if (event.line == 0) throw;
    throw Error(script + ":" + std::to_string(event.line) + ": " + fault.what());
  }
  if (is_announced)
    std::fprintf(stderr, "%s: %zu triangles, prepared in %.0f s\n", add.source.mesh.c_str(),
                 find_object(session.objects(), add.name)->model->source.mesh.triangles.size(),
                 ms_since(start) / 1e3);
}

void open_session(OpenedRun& run, const SessionConfig& config, std::future<ObjectParts> first_object) {
  StaticMap* const octree =
      config.map_updates ? &run.map.octree.load() : nullptr;  // read only if it may change
  run.session = std::make_unique<Session>(run.map, config, octree);
  run.report.renderer = run.session->renderer();
  std::fprintf(stderr, "rendering with %s\n", run.session->renderer().c_str());
  // Objects are loaded now, so an unreadable mesh is reported before the first frame.
  for (const ScriptEvent& event : run.script.events)
    if (const auto* add = std::get_if<AddObject>(&event.action))
      add_object(*run.session, event, *add, run.options.script, std::move(first_object));
  // Afterwards, since another thread computes the first object's levels of detail meanwhile.
  if (run.options.unknown_is_solid) make_unknown_solid(*run.session, run.report.times);
  for (const ObjectNotice& notice : run.session->take_notices())
    std::fprintf(stderr, "roomradar: %s%s\n", notice.name.c_str(), notice.text.c_str());
  release_unused_memory();  // what reading the map's files needed
}

/// Wraps the frames so they are recorded, if requested.
void record_frames(OpenedRun& run, std::unique_ptr<FrameSource>& frames) {
  const RunOptions& options = run.options;
  if (options.record_session.empty()) return;
  run.recorder.emplace(options.record_session, options, run.map.info,
                       gives_calibrated_frames(options.source, options.calibration));
  // Recorded at the start, where they were loaded: the window's user may use one before its event.
  for (const ScriptEvent& event : run.script.events)
    if (const auto* add = std::get_if<AddObject>(&event.action))
      run.recorder->write(
          run.recorder->with_mesh_kept(event, find_object(run.session->objects(), add->name)->model->source),
          0);
  frames = run.recorder->recorded(std::move(frames));
}

void play_frames(OpenedRun& run, std::unique_ptr<FrameSource> frames) {
  auto played = std::make_unique<PlaybackSource>(std::move(frames), run.options.at_end);
  run.playback = played.get();
  run.source = ended_by_interrupt(std::move(played));
}

/// Opens the map. Returns the settings of the tiles if the map is a building.
std::optional<TileWindowConfig> open_map(OpenedRun& run) {
  const RunOptions& options = run.options;
  if (!is_building(options.map)) {
    if (options.max_memory_mb > 0.0)
      throw Error("--max-memory: " + options.map +
                  " is the map of a room, which is loaded as a whole; the option is for buildings");
    mmap_large_allocations(kLargeFile_bytes);
    run.map = load_map(options.map, KeyframeReading::kMeanwhile);
    return std::nullopt;
  }
  OpenedBuilding building = open_building(options, run.script);
  run.map = std::move(building.map);
  return std::move(building.tiles);
}

void add(std::unique_ptr<FrameSink> sink, FrameSinks& sinks) {
  if (sink) sinks.push_back(std::move(sink));
}

}  // namespace

std::unique_ptr<OpenedRun> open_run(const RunOptions& options, UiChannel* link) {
  auto opened = std::make_unique<OpenedRun>(options);
  OpenedRun& run = *opened;
  run.report.command = "run";
  run.report.source = options.source;
  run.report.settings = settings_of(options);
  require_writable(options.report);
  require_writable(options.frames_csv);
  require_writable(options.trajectory);
  if (options.stream != "-") require_writable(options.stream);
  require_outside_maps(options.video);
  require_contents_outside_maps(options.pictures);
  const std::filesystem::path kept = open_objects_folder(options);
  run.script = script_of(options, kept);
  require_can_save_map(options, run.script);
  require_one_quality(options, run.script);
  if (!options.record_session.empty()) require_can_become_session(options.record_session);
  std::future<ObjectParts> first_object = first_object_of(run.script);
  std::optional<TileWindowConfig> tiles = open_map(run);
  if (!options.save_map.empty()) run.map.texture.load();  // is carried over when the map is saved
  say_if_up_is_not_known(run.map.info, options.map);
  const bool has_picture = makes_picture(options, link != nullptr);
  std::optional<ReplayCheck> check;
  std::unique_ptr<FrameSource> frames = open_frames(run, check);
  open_budget(run, has_picture);
  open_session(run, config_of(run, has_picture, std::move(tiles)), std::move(first_object));
  std::unique_ptr<FrameSink> video = video_sink(options);
  std::unique_ptr<FrameSink> pictures = picture_sink(options);
  std::unique_ptr<FrameSink> stream = stream_sink(options);
  // Last, so that a run that fails to open leaves no folder that blocks the next attempt.
  record_frames(run, frames);
  play_frames(run, std::move(frames));
  add(fingerprint_sink(run.recorder ? &*run.recorder : nullptr, std::move(check)), run.sinks);
  add(std::move(video), run.sinks);
  add(frame_use_sink(options), run.sinks);
  add(trajectory_sink(options), run.sinks);
  add(std::move(stream), run.sinks);
  add(std::move(pictures), run.sinks);
  add(kept_objects_sink(kept, *run.session), run.sinks);
  if (link != nullptr)
    run.host.emplace(*link, *run.session, *run.playback, run.report.times, shown_room(run.map), run.is_live);
  return opened;
}

}  // namespace roomradar
