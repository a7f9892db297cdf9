// holes.hpp: where a scan has not looked, as a person can go there and look.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

enum class HoleKind {
  kUnknownSpace,   ///< space inside the scan that no ray has crossed: in the shadow of something, a corner
  kSurfaceBorder,  ///< the surface ends though space was seen on both sides of it
  kOuterBorder,    ///< where the scan as a whole ends
};
std::string_view to_string(HoleKind kind);

/// One place where nothing is known. The world is the map's.
struct Hole {
  HoleKind kind = HoleKind::kUnknownSpace;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< its middle, m
  double size_m = 0.0;                                       ///< between its furthest points
  double area_m2 = 0.0;  ///< of the border between what is known and what is not
  /// Unit, from what is known into the hole: the way to look.
  Eigen::Vector3d look_direction_world = Eigen::Vector3d::UnitX();
  /// A free place to look from, m; none where no free way leads to the hole.
  std::optional<Eigen::Vector3d> stand_world;
};

class StaticMap;
struct Frontier;

/// The frontier's holes, and those of the surface itself: loops of border edges with surface all round and at
/// least min_border_size_m across, unless the frontier knows of the place already (a cell within three cells
/// of the loop's middle). By kind, each largest first.
std::vector<Hole> find_holes(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                             double min_border_size_m = 0.12);

/// "unknown space at (1.20, -0.35, 0.40) m, 0.80 m wide, 0.31 m2; look along (0.87, -0.40, -0.30) from (0.16,
/// 0.13, 0.76)"
std::string describe(const Hole& hole);

}  // namespace roomradar
