// radar_query.hpp: a query of CyberRadar, and its settings.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <string_view>

#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

enum class RadarMode {
  kSampled,  ///< few exact tests: fast; bounds as wide as the depth range within a pixel
  kExact     ///< exact tests until lower_m = upper_m = contact_distance_m
};
constexpr std::string_view to_string(RadarMode mode) {
  return mode == RadarMode::kExact ? "exact" : "sampled";
}

struct RadarConfig {
  RadarMode mode = RadarMode::kExact;
  /// Pixels along the longer side of the object's outline, 1 to 4096. Determines Contact::pixel_m and the
  /// width of sampled mode's bounds. Sampled mode uses this resolution once a direction in the object's frame
  /// has repeated often enough that a finer M pays. Before that M has at most 40 pixels, or 64 for an object
  /// of few triangles. Exact mode chooses the fastest resolution; its result does not depend on it.
  int resolution_px = 64;
  friend bool operator==(const RadarConfig&, const RadarConfig&) = default;
};
/// @throws Error naming the field, its value and the rule
void require_valid(const RadarConfig& config);

struct RadarQuery {
  TreeInstance object;                                        ///< not in the scene, except as own_tree
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();  ///< any length but 0
  double distance_m = 0.0;                                    ///< max distance to search, > 0
  /// Inflates the object by this on all sides: lower_m then holds for any motion that deviates no farther
  /// from the straight one (rotation, noise). If > 0, only lower_m is meaningful: upper_m is infinite,
  /// overlap and touching give lower_m = 0, and surfaces that the object leaves count too.
  double margin_m = 0.0;
  /// Index of the object's own tree in the scene, which is skipped.
  std::size_t own_tree = kNotInScene;
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
};

/// Returns false for a query that CyberRadar::query() rejects by itself, whatever the scene.
bool is_valid(const RadarQuery& query);

/// Returns the distance below which surfaces touch this object, m: 1 um plus the float resolution at its
/// size.
double touching_m(const TriangleTree& object);

}  // namespace roomradar
