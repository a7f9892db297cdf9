// session_folder.cpp: writes and reads recorded sessions.
#include "app/cli/session_folder.hpp"

#include <array>
#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <sstream>
#include <system_error>
#include <utility>

#include "app/models/model_file.hpp"
#include "app/quality/quality_json.hpp"
#include "app/sources/formats/camera_rig_json.hpp"
#include "app/sources/recordings/spooled_source.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/folders.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;  // as in quality_json.hpp; do not copy untrusted nested values: copying
                                      // recurses

constexpr const char* kSettings = "session.json";
constexpr const char* kEvents = "events.txt";
constexpr const char* kFrames = "frames";
constexpr const char* kMeshes = "meshes";
constexpr const char* kResults = "results.txt";
constexpr const char* kFormat = "roomradar session";
constexpr int kFormatVersion = 3;
constexpr int kOldestVersion = 2;  // such sessions keep the files of meshes
constexpr std::uintmax_t kMaxSettingsBytes = 1U << 20U;

Json read_settings(const fs::path& folder) {
  const fs::path path = folder / kSettings;
  Json json = Json::parse(read_bytes(path, "the settings of a recorded session", kMaxSettingsBytes), nullptr,
                          /*allow_exceptions=*/false);
  if (!json.is_object() || !json.contains("format") || json["format"] != kFormat)
    throw Error(path.string() + ": is not the settings of a recorded session, or is damaged");
  if (!json.contains("format_version") || !json["format_version"].is_number_integer())
    throw Error(path.string() + ": does not say its format version; is it damaged?");
  if (json["format_version"] < kOldestVersion || json["format_version"] > kFormatVersion)
    throw Error(path.string() + ": is of format version " + json["format_version"].dump() +
                ", and this program reads versions " + std::to_string(kOldestVersion) + " and " +
                std::to_string(kFormatVersion));
  return json;
}

/// Returns the seconds of --commit-changes, nothing if they were not given; throws Error if they are not
/// valid.
std::optional<double> commit_after_s(const Json& json, const fs::path& folder) {
  constexpr double kMost_s = 86400.0;
  const char* const key = json.contains("commit_s") ? "commit_s" : "adopt_s";  // of earlier sessions
  if (!json.contains(key)) return {};
  const double seconds = json[key].is_number() ? json[key].get<double>() : -1.0;
  if (!(seconds > 0.0 && seconds <= kMost_s))
    throw Error((folder / kSettings).string() + ": " + key + " = " + format_number(seconds) +
                ": must be seconds, up to a day");
  return seconds;
}

template <typename Value>
Value choice_of(const Json& json, const char* key, std::initializer_list<Value> values,
                const fs::path& folder) {
  const auto word = json.at(key).get<std::string>();
  for (const Value value : values)
    if (to_string(value) == word) return value;
  throw Error((folder / kSettings).string() + ": " + key + " \"" + word + "\" is not known");
}

}  // namespace

void require_can_become_session(const fs::path& folder) {
  require_contents_outside_maps(folder);
  std::error_code fault;
  if (fs::exists(folder, fault) && !is_empty_folder(folder, fault))
    throw Error(folder.string() + ": is not empty; a session needs an empty or new folder");
}

SessionRecorder::SessionRecorder(fs::path folder, const RunOptions& options, const MapInfo& map,
                                 bool are_calibrated)
    : folder_(std::move(folder)) {
  make_folder(folder_);
  require_can_become_session(folder_);
  Json json = {{"format", kFormat},
               {"format_version", kFormatVersion},
               {"source", options.source},
               {"calibrated", are_calibrated},
               {"map", fs::absolute(options.map).lexically_normal().string()},
               {"map_sha256", octree_checksum(map)},
               {"poses", to_string(options.poses)},
               {"surfaces", to_string(options.surfaces)},
               {"unknown_is_solid", options.unknown_is_solid},
               {"quality", to_json(options.quality)},
               {"at_end", to_string(options.at_end)}};
  if (options.commit_after_s) json["commit_s"] = *options.commit_after_s;
  write_bytes(folder_ / kSettings, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  events_.open(folder_ / kEvents);
  events_ << "# events of " << options.source << ", as applied\n" << std::flush;
  require_written(events_, folder_ / kEvents);
  results_.open(folder_ / kResults);
  results_ << "# frame, fingerprint of the objects, fingerprint of the picture (0: none was made)\n"
           << std::flush;
  require_written(results_, folder_ / kResults);
}

std::unique_ptr<FrameSource> SessionRecorder::recorded(std::unique_ptr<FrameSource> source) const {
  constexpr std::size_t kAhead = 2;  // so a run shows the newest frame, also after a pause
  return SpooledSource::kept(std::move(source), folder_ / kFrames, kAhead);
}

ScriptEvent SessionRecorder::with_mesh_kept(ScriptEvent event, const Model& model) {
  auto* const add = std::get_if<AddObject>(&event.action);
  if (add == nullptr || add->source.mesh == "teapot") return event;
  const std::string name = "mesh-" + std::to_string(++meshes_) + kModelCopyExtension;
  std::error_code fault;
  fs::create_directories(folder_ / kMeshes, fault);
  if (fault)
    throw Error((folder_ / kMeshes).string() + ": the model cannot be copied: " + system_reason(fault));
  write_model_copy(model, folder_ / kMeshes / name);
  add->source.mesh = std::string(kMeshes) + "/" + name;
  add->source.size_m.reset();
  add->source.up.reset();
  return event;
}

void SessionRecorder::write(ScriptEvent event, std::int64_t run_frame) {
  event.frame = run_frame;
  event.time_s.reset();
  events_ << to_line(event) << '\n' << std::flush;
  require_written(events_, folder_ / kEvents);
}

void SessionRecorder::write(const FrameFingerprint& fingerprint) {
  std::array<char, 80> line{};
  format_classic(line.data(), line.size(), "%" PRId64 " %016" PRIx64 " %016" PRIx64 "\n",
                 fingerprint.run_frame, fingerprint.objects, fingerprint.picture);
  results_ << line.data() << std::flush;
  require_written(results_, folder_ / kResults);
}

bool is_session_folder(const fs::path& folder) {
  std::error_code fault;
  return fs::is_regular_file(folder / kSettings, fault);
}

bool is_session_calibrated(const fs::path& folder) {
  return said_calibrated(read_settings(folder), (folder / kSettings).string());
}

bool is_session_events(const fs::path& file) {
  return file.filename() == kEvents && is_session_folder(file.parent_path());
}

Script read_session_events(const fs::path& file) {
  Script script = read_script(file, LastLine::kMayBeCut);
  if (read_settings(file.parent_path())["format_version"] != kOldestVersion) return script;
  // In that version, an .obj had z up, and an object's origin was that of its file.
  for (ScriptEvent& event : script.events) {
    auto* const add = std::get_if<AddObject>(&event.action);
    if (add == nullptr) continue;
    add->source.origin = ModelOrigin::kAsInFile;
    if (fs::path(add->source.mesh).extension() == ".obj") add->source.up = UpAxis::kZ;
  }
  return script;
}

RunOptions read_session(const fs::path& folder) {
  const Json json = read_settings(folder);
  RunOptions options;
  options.source = folder.string();
  options.script = (folder / kEvents).string();
  try {
    options.map = json.at("map").get<std::string>();
    options.poses =
        choice_of(json, "poses", {PoseOrigin::kAuto, PoseOrigin::kTracked, PoseOrigin::kRecorded}, folder);
    options.surfaces = choice_of(
        json, "surfaces",
        {SurfacePolicy::kMap, SurfacePolicy::kBorder, SurfacePolicy::kSkirt, SurfacePolicy::kHoles}, folder);
    options.unknown_is_solid = json.at("unknown_is_solid").get<bool>();
    options.quality = run_quality_of(json.at("quality"), (folder / kSettings).string() + ": quality");
    options.at_end = choice_of(json, "at_end", {AtEnd::kEnd, AtEnd::kStay, AtEnd::kLoop}, folder);
    options.commit_after_s = commit_after_s(json, folder);
  } catch (const Json::exception& fault) {
    throw Error((folder / kSettings).string() + ": is damaged: " + fault.what());
  }
  return options;
}

std::unique_ptr<FrameSource> open_session_frames(const fs::path& folder) {
  return SpooledSource::again(folder / kFrames);
}

std::string map_difference(const fs::path& folder, const MapInfo& map) {
  const Json settings = read_settings(folder);
  const auto recorded = settings.find("map_sha256");
  if (recorded == settings.end() || *recorded == "" || *recorded == octree_checksum(map)) return {};
  return folder.string() + ": was recorded with a different map; results will differ";
}

ReplayCheck::ReplayCheck(const fs::path& folder) {
  std::ifstream file(folder / kResults);
  for (std::string line; std::getline(file, line) && !file.eof();) {  // ignores a last line that is cut off
    FrameFingerprint fingerprint;
    if (std::sscanf(line.c_str(), "%" SCNd64 " %" SCNx64 " %" SCNx64, &fingerprint.run_frame,
                    &fingerprint.objects, &fingerprint.picture) == 3)
      recorded_.push_back(fingerprint);
  }
}

void ReplayCheck::compare(const FrameFingerprint& fingerprint) {
  if (next_ == recorded_.size()) return;  // recording cut off: nothing to compare with
  const FrameFingerprint& recorded = recorded_[next_++];
  const bool both_pictures = recorded.picture != 0 && fingerprint.picture != 0;
  const bool is_same = recorded.run_frame == fingerprint.run_frame &&
                       recorded.objects == fingerprint.objects &&
                       (!both_pictures || recorded.picture == fingerprint.picture);
  if (is_same) {
    ++same_;
  } else if (different_++ == 0) {
    first_different_ = recorded.run_frame;
  }
}

}  // namespace roomradar
