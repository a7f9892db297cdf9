// hole.hpp: an unobserved region of a scan.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string_view>

namespace roomradar {

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

}  // namespace roomradar
