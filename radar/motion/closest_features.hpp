// closest_features.hpp: closest features of two triangles, and reduction of contact points to a few per
// normal.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "radar/geometry/triangle_gap.hpp"
#include "radar/motion/closest_point.hpp"

namespace roomradar {

/// A triangle with precomputed edges. Edge i runs from vertex i to the next vertex.
struct Face : FrameTriangle {
  /// edge[i]: vector from vertex i to the next vertex. inward[i]: vector in the triangle's plane,
  /// perpendicular to edge i, towards the third vertex. Neither has unit length.
  std::array<Eigen::Vector3d, 3> edge, inward;
};

/// Computes the edges of a triangle.
Face face_of(const FrameTriangle& triangle);
/// Returns true if an edge of one triangle passes through the other triangle.
bool cross(const Face& a, const Face& b);

/// Returns true if a unit direction is at most 60 degrees from the triangle's normal. At an edge whose two
/// faces have normals up to 120 degrees apart, every direction between the normals is within the limit for at
/// least one face. With a limit of 90 degrees, rounding would admit directions parallel to the face.
inline bool is_outside(const Eigen::Vector3d& direction, const FrameTriangle& t) {
  return direction.dot(t.normal) > 0.5 - 1e-9;
}

/// Interval on an axis; empty at first.
struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  void include(double at) {
    low = std::min(low, at);
    high = std::max(high, at);
  }
};
/// Returns the range of the vertices' coordinates along a direction.
inline Range range_along(const Eigen::Vector3d& direction, const std::array<Eigen::Vector3d, 3>& corners) {
  Range range;
  for (const Eigen::Vector3d& corner : corners) range.include(direction.dot(corner));
  return range;
}

/// Collects the closest features of pairs of triangles. Each pair consists of one triangle of an object and
/// one of the scene.
struct FeatureCollector {
  /// Max distance between closest features, m.
  double reach_m;
  bool object_is_closed;
  bool scene_is_one_sided;
  /// Kind of the scene's surface, copied into ClosestPoint::kind.
  SurfaceKind kind;
  /// Pose, in the world, of the frame in which the triangles are given.
  const Eigen::Isometry3d& T_world_frame;
  /// Output: the collector appends its points to this vector.
  std::vector<ClosestPoint>& found;
  /// Output: points on edges and vertices of a scene triangle whose inside is nearer to the object's point.
  /// The triangle beyond the edge finds the same points, which are then no closest features: their normals
  /// are none of the surface's.
  std::vector<ClosestPoint>& refused;

  /// Appends the closest features of one pair of triangles. Returns true if the triangles intersect and the
  /// scene's surface is not one-sided.
  bool look(const FrameTriangle& object, const FrameTriangle& scene) const;
  /// Removes the refused points from those found.
  void erase_refused() const;

 private:
  /// Appends a point. Omits points farther than reach_m, with a zero normal, or on the inside of a one-sided
  /// surface.
  /// @param inside_is_nearer  the point is refused
  void add(const Eigen::Vector3d& on_scene, const Eigen::Vector3d& normal, double gap_m, const Face& s,
           bool inside_is_nearer = false) const;
  /// Returns the scene triangle's normal, negated if an object vertex is below the scene triangle's plane. If
  /// the vertex touches the plane, the other vertices of the object's triangle decide the sign.
  /// @param height_m  height of the object vertex above the plane
  /// @param heights  range of the heights of all vertices of the object's triangle
  [[nodiscard]] Eigen::Vector3d off_scene(double height_m, const Face& o, const Face& s,
                                          const Range& heights) const;
  /// Returns the object triangle's normal, negated if necessary so that it points from a scene vertex towards
  /// the object. Returns zero if the vertex touches the plane and its side cannot be decided.
  /// @param height_m  height of the scene vertex above the object triangle's plane
  /// @param heights  range of the heights of all vertices of the scene's triangle
  [[nodiscard]] Eigen::Vector3d off_object(double height_m, const Eigen::Vector3d& corner, const Face& o,
                                           const Range& heights) const;
  /// Appends the shortest segment between edge i of the object's triangle and edge j of the scene's, if it is
  /// perpendicular to both.
  void look_at_edges(const Face& o, std::size_t i, const Face& s, std::size_t j) const;
};

/// Contact reduction: selects the points that support an object best. Groups the points by normal into up to
/// four groups. In each group, keeps the point with the smallest gap. Also keeps the outermost point in each
/// of eight directions perpendicular to the normal. A point with a 1 mm larger gap must be 2 cm farther out
/// to be preferred.
/// @param all   candidates. The function removes points from this vector
/// @param[out] kept  the selected points, at most kMaxClosestPoints
void keep_the_outermost(std::vector<ClosestPoint>& all, std::vector<ClosestPoint>& kept);

}  // namespace roomradar
