// map_info.cpp: a map's description as text and as JSON.
#include "mapping/map/map_info.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "mapping/history/visits.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/storage/sha256.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

std::string in_megabytes(std::uint64_t bytes) {
  std::array<char, 32> text{};
  format_classic(text.data(), text.size(), "%.1f MB", static_cast<double>(bytes) / 1e6);
  return text.data();
}

std::string extents(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return "nothing";
  const Eigen::Vector3d &low = box.min(), &high = box.max();
  std::array<char, 160> text{};
  format_classic(text.data(), text.size(), "x %.2f..%.2f m, y %.2f..%.2f m, z %.2f..%.2f m", low.x(),
                 high.x(), low.y(), high.y(), low.z(), high.z());
  return text.data();
}

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "roomradar map";

Json corners(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return nullptr;
  const Eigen::Vector3d &low = box.min(), &high = box.max();
  return {{"min_m", {low.x(), low.y(), low.z()}}, {"max_m", {high.x(), high.y(), high.z()}}};
}

// Reads fields; throws an Error that names the fault if a field is missing or invalid.
class Fields {
 public:
  Fields(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json.is_object()) fail("is not a JSON object");
  }
  [[noreturn]] void fail(const std::string& fault) const { throw Error(where_ + ": " + fault); }

  [[nodiscard]] const Json& at(const char* name) const {
    const auto found = json_.find(name);
    if (found == json_.end()) fail("\"" + std::string(name) + "\" is missing");
    return *found;
  }
  [[nodiscard]] Fields object(const char* name) const { return {at(name), where_ + ": " + name}; }
  [[nodiscard]] std::string text(const char* name) const {
    if (!at(name).is_string()) fail("\"" + std::string(name) + "\" is not text");
    return at(name).get<std::string>();
  }
  [[nodiscard]] std::uint64_t count(const char* name) const {
    const Json& value = at(name);
    if (!value.is_number_integer() || value.get<std::int64_t>() < 0)
      fail("\"" + std::string(name) + "\" is not a whole number >= 0");
    return value.get<std::uint64_t>();
  }
  [[nodiscard]] int whole(const char* name) const {
    if (count(name) > std::numeric_limits<int>::max()) fail("\"" + std::string(name) + "\" is too large");
    return static_cast<int>(count(name));
  }
  [[nodiscard]] double number(const char* name) const {
    if (!at(name).is_number() || !std::isfinite(at(name).get<double>()))
      fail("\"" + std::string(name) + "\" is not a number");
    return at(name).get<double>();
  }
  template <int size>
  [[nodiscard]] Eigen::Matrix<double, size, 1> numbers(const char* name) const {
    const Json& value = at(name);
    Eigen::Matrix<double, size, 1> out;
    bool good = value.is_array() && value.size() == static_cast<std::size_t>(size);
    for (int i = 0; good && i < size; ++i) {
      good = value[static_cast<std::size_t>(i)].is_number();
      if (good) out[i] = value[static_cast<std::size_t>(i)].get<double>();
    }
    if (!good || !out.allFinite())
      fail("\"" + std::string(name) + "\" is not a list of " + std::to_string(size) + " numbers");
    return out;
  }
  [[nodiscard]] Eigen::AlignedBox3d box(const char* name) const {
    if (at(name).is_null()) return {};
    const Fields corner = object(name);
    return {Eigen::Vector3d(corner.numbers<3>("min_m")), Eigen::Vector3d(corner.numbers<3>("max_m"))};
  }
  [[nodiscard]] const Json& json() const { return json_; }

 private:
  const Json& json_;
  std::string where_;
};

Eigen::Isometry3d pose(const Fields& fields, const char* name) {
  const Eigen::Matrix<double, 16, 1> rows = fields.numbers<16>(name);
  Eigen::Isometry3d T;
  T.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(rows.data());
  if (!is_rigid(T, 1e-6)) fields.fail("\"" + std::string(name) + "\" is not a rigid transform");
  return T;
}

MapCounts counts(const Fields& fields) {
  return {.occupied_leaves = fields.count("occupied_leaves"),
          .free_leaves = fields.count("free_leaves"),
          .sampled_leaves = fields.count("sampled_leaves"),
          .nodes = fields.count("nodes"),
          .memory_bytes = fields.count("memory_bytes"),
          .known_world = fields.box("known_extents"),
          .occupied_world = fields.box("occupied_extents")};
}

MapFile file(const Fields& fields) {
  MapFile found{fields.count("bytes"), fields.text("sha256")};
  const bool hex = std::all_of(found.sha256.begin(), found.sha256.end(),
                               [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
  if (found.sha256.size() != 64 || !hex) fields.fail("\"sha256\" is not 64 hexadecimal digits");
  return found;
}

constexpr std::uint64_t kFirstWithIdentity = 5;  // of the format's versions

void read_identity(const Fields& fields, MapInfo& info) {
  info.id = fields.text("id");
  info.created = fields.text("created");
  info.changed = fields.text("changed");
  info.revision = fields.whole("revision");
  info.parent_revision = fields.whole("parent_revision");
  const Json& sessions = fields.at("sessions");
  if (!sessions.is_array()) fields.fail("\"sessions\" is not a list");
  for (const Json& one : sessions) {
    const Fields session(one, "sessions");
    info.sessions.push_back({session.text("source"), session.text("source_id"), session.text("made_at"),
                             static_cast<std::int64_t>(session.count("frames_read")),
                             static_cast<std::int64_t>(session.count("frames_fused"))});
  }
}

/// Replaces the full paths of an earlier version by sessions.
void name_sessions(MapInfo& info) {
  constexpr std::string_view kBetween = "; ";
  std::string names;
  for (std::size_t begin = 0; begin <= info.source.size();) {
    const std::size_t end = std::min(info.source.find(kBetween, begin), info.source.size());
    const std::string source = info.source.substr(begin, end - begin);
    info.sessions.push_back({without_folders(source), source_id_of(source), "", 0, 0});
    names += std::string(names.empty() ? "" : kBetween) + info.sessions.back().source;
    begin = end + kBetween.size();
  }
  info.source = names;
}

}  // namespace

std::string source_id_of(const std::string& source) { return sha256_of(source).substr(0, 16); }

bool knows_recorded_world(const MapInfo& info) {
  const auto poses = info.settings.find(kPosesSetting);
  return (poses != info.settings.end() && poses->second == to_string(PoseOrigin::kRecorded)) ||
         !info.T_world_recorded.isApprox(Eigen::Isometry3d::Identity(), 1e-12);
}

bool share_world(const MapInfo& a, const MapInfo& b) {
  const auto of_a = a.files.find(kMapKeyframesFile), of_b = b.files.find(kMapKeyframesFile);
  return a.keyframes > 0 && of_a != a.files.end() && of_b != b.files.end() &&
         of_a->second.sha256 == of_b->second.sha256;
}

SurfaceConfig surface_config_of(const MapInfo& info) {
  SurfaceConfig config;
  const auto said = info.settings.find(kDeviationSetting);
  if (said == info.settings.end()) return config;
  const char* const end = said->second.data() + said->second.size();
  const auto parsed = std::from_chars(said->second.data(), end, config.max_deviation_m);
  if (parsed.ec != std::errc() || parsed.ptr != end || !(config.max_deviation_m >= 0.0F) ||
      !std::isfinite(config.max_deviation_m))
    throw Error("map.json: settings: " + std::string(kDeviationSetting) + " is \"" +
                said->second.substr(0, 40) + "\"; must be metres, 0 or more");
  return config;
}

std::string describe_up(const std::string& up_source) {
  if (up_source == "accelerometer") return "from gravity";
  if (up_source == "plane") return "from a level surface";
  if (up_source == "given") return "as given by --up";
  return up_source == "none" ? "not known" : up_source;
}

std::string describe(const MapInfo& info) {
  std::string text;
  const auto line = [&](const char* name, const std::string& value) {
    text += std::string(name) + std::string(16 - std::string_view(name).size(), ' ') + value + "\n";
  };
  std::array<char, 32> resolution{};
  format_classic(resolution.data(), resolution.size(), "%g m", info.resolution_m);
  line("source", info.source);
  if (!info.id.empty()) line("map", info.id);
  if (!info.created.empty()) line("created", info.created);
  if (!info.changed.empty()) line("changed", info.changed);
  line("resolution", resolution.data());
  line("frames",
       std::to_string(info.frames_fused) + " fused of " + std::to_string(info.frames_read) + " read");
  line("up", describe_up(info.up_source));
  line("octree", std::to_string(info.counts.occupied_leaves) + " occupied and " +
                     std::to_string(info.counts.free_leaves) + " free leaves, " +
                     std::to_string(info.counts.nodes) + " nodes, " + in_megabytes(info.counts.memory_bytes) +
                     " in memory");
  line("known", extents(info.counts.known_world));
  line("occupied", extents(info.counts.occupied_world));
  line("mesh", std::to_string(info.triangles) + " triangles, " + std::to_string(info.vertices) + " vertices");
  line("database", std::to_string(info.keyframes) + " keyframes");
  line("trajectory", std::to_string(info.poses) + " poses");
  if (info.revision > 0) line("revision", std::to_string(info.revision));
  for (const auto& [name, file] : info.files) line(name.c_str(), in_megabytes(file.bytes));
  for (const auto& [name, value] : info.settings) line(name.substr(0, 15).c_str(), value);
  line("format", std::to_string(info.format_version) + ", by roomradar " + info.tool_version);
  return text;
}

std::string to_json(const MapInfo& info) {
  Json json;
  json["format"] = kFormat;
  json["format_version"] = info.format_version;
  json["tool_version"] = info.tool_version;
  json["source"] = info.source;
  json["id"] = info.id;
  json["created"] = info.created;
  json["changed"] = info.changed;
  json["sessions"] = Json::array();
  for (const MapSession& session : info.sessions)
    json["sessions"].push_back({{"source", session.source},
                                {"source_id", session.source_id},
                                {"made_at", session.made_at},
                                {"frames_read", session.frames_read},
                                {"frames_fused", session.frames_fused}});
  json["resolution_m"] = info.resolution_m;
  json["frames_read"] = info.frames_read;
  json["frames_fused"] = info.frames_fused;
  json["up_source"] = info.up_source;
  json["T_world_recorded"] = Json::array();
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      json["T_world_recorded"].push_back(info.T_world_recorded.matrix()(row, column));
  json["octree"] = {{"occupied_leaves", info.counts.occupied_leaves},
                    {"free_leaves", info.counts.free_leaves},
                    {"sampled_leaves", info.counts.sampled_leaves},
                    {"nodes", info.counts.nodes},
                    {"memory_bytes", info.counts.memory_bytes},
                    {"known_extents", corners(info.counts.known_world)},
                    {"occupied_extents", corners(info.counts.occupied_world)}};
  json["mesh"] = {{"vertices", info.vertices}, {"triangles", info.triangles}};
  json["keyframes"] = info.keyframes;
  json["poses"] = info.poses;
  json["revision"] = info.revision;
  json["parent_revision"] = info.parent_revision;
  json["settings"] = Json::object();
  for (const auto& [name, value] : info.settings) json["settings"][name] = value;
  json["files"] = Json::object();
  for (const auto& [name, entry] : info.files)
    json["files"][name] = {{"bytes", entry.bytes}, {"sha256", entry.sha256}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

MapInfo parse_map_info(const std::string& text, const std::string& where) {
  const Json json = Json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (json.is_discarded()) throw Error(where + ": is not JSON, or is cut short");
  const Fields fields(json, where);
  if (fields.text("format") != kFormat) fields.fail("is not the description of a roomradar map");
  MapInfo info;
  const std::uint64_t version = fields.count("format_version");
  if (version > kMapFormatVersion)
    fields.fail("is of format version " + std::to_string(version) + ", and this roomradar reads up to " +
                std::to_string(kMapFormatVersion) + "; use a later roomradar");
  if (version == 0) fields.fail("\"format_version\" is 0; the first is 1");
  info.format_version = static_cast<int>(version);
  info.tool_version = fields.text("tool_version");
  info.source = fields.text("source");
  if (version >= kFirstWithIdentity)
    read_identity(fields, info);
  else
    name_sessions(info);
  info.resolution_m = fields.number("resolution_m");
  if (!(info.resolution_m >= 0.001 && info.resolution_m <= 1.0))
    fields.fail("\"resolution_m\" is not between 0.001 and 1");
  info.frames_read = static_cast<std::int64_t>(fields.count("frames_read"));
  info.frames_fused = static_cast<std::int64_t>(fields.count("frames_fused"));
  info.up_source = fields.text("up_source");
  info.T_world_recorded = pose(fields, "T_world_recorded");
  info.counts = counts(fields.object("octree"));
  info.vertices = fields.object("mesh").count("vertices");
  info.triangles = fields.object("mesh").count("triangles");
  info.keyframes = fields.count("keyframes");
  info.poses = fields.count("poses");
  const Fields settings = fields.object("settings");
  for (const auto& entry : settings.json().items())
    info.settings[entry.key()] = settings.text(entry.key().c_str());
  const Fields files = fields.object("files");
  for (const auto& entry : files.json().items())
    info.files[entry.key()] = file(files.object(entry.key().c_str()));
  return info;
}

}  // namespace roomradar
