// holes.hpp: unobserved regions of a scan, with places from which a person can observe them.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class HoleKind {
  kUnknownSpace,   ///< space inside the scan that no ray crossed: an occluded region, a corner
  kSurfaceBorder,  ///< the surface ends although the space on both sides was observed
  kOuterBorder,    ///< end of the scan as a whole
};
std::string_view to_string(HoleKind kind);

/// One unobserved region, in the map's world.
struct Hole {
  HoleKind kind = HoleKind::kUnknownSpace;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< centre, m
  double size_m = 0.0;                                       ///< distance between its farthest points
  double area_m2 = 0.0;                                      ///< area of the border between known and unknown
  /// Unit viewing direction, from known space into the hole.
  Eigen::Vector3d look_direction_world = Eigen::Vector3d::UnitX();
  /// Free position to look from, m; unset if none has a free line of sight.
  std::optional<Eigen::Vector3d> viewpoint_world;
};

class StaticMap;
struct Frontier;

/// Returns the frontier's holes and those of the surface: border loops surrounded by surface, at least
/// min_border_size_m across. Skips loops whose centre is within three cells of a cell of the frontier's
/// holes. Sorted by kind, then largest first.
std::vector<Hole> find_holes(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                             double min_border_size_m = 0.12);

/// Returns text such as "unknown space at (1.20, -0.35, 0.40) m, 0.80 m wide, 0.31 m2; look along (0.87,
/// -0.40, -0.30) from (0.16, 0.13, 0.76)".
std::string describe(const Hole& hole);

}  // namespace roomradar
