// radar_query.hpp: a query of CyberRadar, and its settings.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <string_view>

#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

enum class RadarMode {
  /// Runs few exact tests. Fast; the bounds may be apart by the depth range within a pixel.
  kSampled,
  /// Runs exact tests until lower_m = upper_m = contact_distance_m.
  kExact
};
constexpr std::string_view to_string(RadarMode mode) {
  return mode == RadarMode::kExact ? "exact" : "sampled";
}

struct RadarConfig {
  RadarMode mode = RadarMode::kExact;
  /// Pixels along the longer side of the object's outline in its height map M, 1 to 4096. Determines
  /// Contact::pixel_m and the width of sampled mode's bounds. Sampled mode uses this resolution only once the
  /// direction in the object's frame has repeated often enough to pay for building the map. Until then, M has
  /// at most 40 pixels per side, or 64 for an object of fewer than 500 triangles. Exact mode chooses the
  /// fastest resolution; its result does not depend on it.
  int resolution_px = 64;
  friend bool operator==(const RadarConfig&, const RadarConfig&) = default;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const RadarConfig& config);

struct RadarQuery {
  /// The moving object. Must not be in the scene, except as the tree given by own_tree.
  TreeInstance object;
  /// Direction of motion; any length except 0.
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();
  /// Max distance to search, > 0.
  double distance_m = 0.0;
  /// Inflates the object by this distance on all sides, m, >= 0. lower_m then holds for every motion that
  /// deviates from the straight one by at most this much (due to rotation or noise). If > 0, only lower_m is
  /// meaningful: upper_m is infinite, overlap and touching give lower_m = 0, and back-facing surfaces count
  /// too.
  double margin_m = 0.0;
  /// Index in the scene of the object's own tree, which is skipped.
  std::size_t own_tree = kNotInScene;
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
};

/// Returns false for a query that CyberRadar::query() rejects for every scene.
bool is_valid(const RadarQuery& query);

/// Returns the distance below which surfaces touch this object, m: 1 um plus the float resolution at its
/// size.
double touching_m(const TriangleTree& object);

}  // namespace roomradar
