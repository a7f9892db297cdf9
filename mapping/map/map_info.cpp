// map_info.cpp: a map's description as text.
#include "mapping/map/map_info.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <string_view>

#include "mapping/map/map_files.hpp"
#include "mapping/types/pose_origin.hpp"
#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/error.hpp"

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

}  // namespace

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
  for (const auto& [name, file] : info.files) line(name.c_str(), in_megabytes(file.bytes));
  for (const auto& [name, value] : info.settings) line(name.substr(0, 15).c_str(), value);
  line("format", std::to_string(info.format_version) + ", by roomradar " + info.tool_version);
  return text;
}

}  // namespace roomradar
