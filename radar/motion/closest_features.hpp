// closest_features.hpp: closest features of two triangles, and selection of those that support an object
// most.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "radar/geometry/triangle_gap.hpp"
#include "radar/motion/closest_point.hpp"

namespace roomradar {

/// A triangle with precomputed edges.
struct Face : FrameTriangle {
  std::array<Eigen::Vector3d, 3> edge, inward;  ///< edge from corner i, and the direction across it towards
                                                ///< the third corner
};

Face face_of(const FrameTriangle& triangle);
/// Returns true if an edge of one triangle passes through the other.
bool cross(const Face& a, const Face& b);

/// Returns true if a unit direction leaves a triangle on its outside, within 60 degrees of its normal. At an
/// edge between faces whose normals are up to 120 degrees apart, every direction between the normals is
/// outside of at least one face. The margin keeps rounding from taking a direction along the inside for
/// outside.
inline bool is_outside(const Eigen::Vector3d& direction, const FrameTriangle& t) {
  return direction.dot(t.normal) > 0.5 - 1e-9;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void include(double at) {
    low = std::min(low, at);
    high = std::max(high, at);
  }
};
inline Range range_along(const Eigen::Vector3d& direction, const std::array<Eigen::Vector3d, 3>& corners) {
  Range range;
  for (const Eigen::Vector3d& corner : corners) range.include(direction.dot(corner));
  return range;
}

/// Collects the closest features of one pair of triangles.
struct FeatureCollector {
  double reach_m;
  bool object_is_closed;
  bool scene_is_one_sided;
  SurfaceKind kind;
  const Eigen::Isometry3d& T_world_frame;
  std::vector<ClosestPoint>& found;

  /// Adds the pair's closest features. Returns true if the triangles cross and the scene's is not one-sided.
  bool look(const FrameTriangle& object, const FrameTriangle& scene) const;

 private:
  /// Adds a point unless it is beyond reach_m, its normal is zero, or it is on the inside of a one-sided
  /// surface.
  void add(const Eigen::Vector3d& on_scene, const Eigen::Vector3d& normal, double gap_m, const Face& s) const;
  /// Returns the scene's normal on the side of an object corner at this height above it.
  /// @param heights  of all corners of the object's triangle
  [[nodiscard]] Eigen::Vector3d off_scene(double height_m, const Face& o, const Face& s,
                                          const Range& heights) const;
  /// Returns the object's normal, turned from a scene corner at this height towards the object; zero if the
  /// side cannot be decided.
  /// @param heights  of all corners of the scene's triangle
  [[nodiscard]] Eigen::Vector3d off_object(double height_m, const Eigen::Vector3d& corner, const Face& o,
                                           const Range& heights) const;
  void look_at_edges(const Face& o, std::size_t i, const Face& s, std::size_t j) const;
};

/// Selects the points that support an object most. For each of up to four normals: the nearest point, and the
/// outermost point in each of eight directions across the normal. A more distant point has to be farther out.
/// Consumes `all`.
void keep_the_outermost(std::vector<ClosestPoint>& all, std::vector<ClosestPoint>& kept);

}  // namespace roomradar
