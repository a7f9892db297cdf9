// radar_query.hpp: a query of CyberRadar, and its settings.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

enum class RadarMode {
  /// Runs few exact tests. Fast. lower_m and upper_m may differ by the depth range within a pixel.
  kSampled,
  /// Runs exact tests until lower_m = upper_m = contact_distance_m.
  kExact,
  /// Renders the two depth passes of the Cyber Radar paper, see PassesRadar. lower_m and upper_m differ by
  /// the depth
  /// range within a pixel. CyberRadar itself answers as in kExact.
  kPasses
};
constexpr std::string_view to_string(RadarMode mode) {
  return mode == RadarMode::kSampled ? "sampled" : mode == RadarMode::kPasses ? "passes" : "exact";
}

/// All modes, in the order of menus.
inline constexpr std::array kRadarModes = {RadarMode::kExact, RadarMode::kSampled, RadarMode::kPasses};
/// Returns the mode of a word of to_string(); nullopt for other words.
constexpr std::optional<RadarMode> radar_mode_of(std::string_view word) {
  for (const RadarMode mode : kRadarModes)
    if (word == to_string(mode)) return mode;
  return std::nullopt;
}

struct RadarConfig {
  RadarMode mode = RadarMode::kExact;
  /// Number of pixels along the longer side of the object's height map M, 1 to 4096; of the rendered passes
  /// in kPasses. Determines Contact::pixel_m and, in sampled mode and passes, the difference of lower_m and
  /// upper_m. Sampled mode first uses at most 40 pixels per side, or 64 for an object of fewer than 500
  /// triangles. Sampled mode changes to a finer map, up to this resolution, once repeated queries with one
  /// direction in the object's frame have cost more than half as much as building that map. Exact mode
  /// chooses M's resolution for speed, without effect on the result.
  int resolution_px = 64;
  friend bool operator==(const RadarConfig&, const RadarConfig&) = default;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const RadarConfig& config);

struct RadarQuery {
  /// The moving object. If the object's own tree is in the scene, own_tree must give its index.
  TreeInstance object;
  /// Direction of motion; any length except 0.
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();
  /// Max distance to search, > 0.
  double distance_m = 0.0;
  /// Inflates the object by this distance on all sides, m, >= 0. lower_m then holds for every motion that
  /// deviates from the straight one by at most margin_m (due to rotation or noise). If margin_m > 0, only
  /// lower_m is meaningful. upper_m is infinite. Overlap and touching give lower_m = 0. Back-facing surfaces
  /// count as contacts, too.
  double margin_m = 0.0;
  /// Index of the object's own tree in the scene, which is skipped; kNotInScene if there is none.
  std::size_t own_tree = kNotInScene;
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
};

/// Returns false if CyberRadar::query() rejects the query, whatever the scene.
bool is_valid(const RadarQuery& query);

/// Returns the distance below which surfaces count as touching this object, m: 1 um plus the float resolution
/// at the object's size.
double touching_m(const TriangleTree& object);

}  // namespace roomradar
