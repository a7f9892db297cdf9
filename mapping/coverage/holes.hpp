// holes.hpp: unobserved regions of a scan, with positions from which a person can observe them.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

class StaticMap;
struct Frontier;

enum class HoleKind {
  kUnknownSpace,   ///< space inside the scan that no ray crossed, e.g. occluded space
  kSurfaceBorder,  ///< border of the mesh that is not near a hole of the other kinds
  kOuterBorder,    ///< end of the scan as a whole
};
std::string_view to_string(HoleKind kind);

/// One unobserved region, in the map's world frame.
struct Hole {
  HoleKind kind = HoleKind::kUnknownSpace;
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< centre, m
  /// Diagonal of its bounding box, m; for kSurfaceBorder: BorderLoop::size_m.
  double size_m = 0.0;
  double area_m2 = 0.0;  ///< area of its border with the known space
  /// Unit viewing direction, from known space into the hole.
  Eigen::Vector3d look_direction_world = Eigen::Vector3d::UnitX();
  /// Free position from which a camera can observe the hole, m; unset if no position with a free line of
  /// sight was found. The line of sight is not tested for kSurfaceBorder.
  std::optional<Eigen::Vector3d> viewpoint_world;
};

/// Returns true for holes inside the scan, not at its end.
inline bool is_inside_scan(const Hole& hole) { return hole.kind != HoleKind::kOuterBorder; }

/// Returns the frontier's holes and the mesh's holes. The latter are border loops that do not enclose a
/// component, with a BorderLoop::size_m of at least min_border_size_m. Leaves out loops whose centre is
/// within three cell widths of a frontier hole's cell. Sorts by area, largest first; the scan's outer borders
/// come last.
std::vector<Hole> find_holes(const StaticMap& map, const Mesh& surface, const Frontier& frontier,
                             double min_border_size_m = 0.12);

/// Returns text such as "unknown space at (1.20, -0.35, 0.40) m, 0.80 m wide, 0.31 m2; look along (0.87,
/// -0.40, -0.30) from (0.16, 0.13, 0.76)".
std::string describe(const Hole& hole);

}  // namespace roomradar
