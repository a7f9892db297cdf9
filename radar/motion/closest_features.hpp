// near_places.hpp: where two triangles are near each other, and which of many such places hold up most.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "radar/geometry/triangle_gap.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// With what is asked of it again and again.
struct Face : FrameTriangle {
  std::array<Eigen::Vector3d, 3> edge, inward;  ///< from corner i on, and across it towards the third corner
};

Face face_of(const FrameTriangle& triangle);
/// Whether an edge of the one goes through the other.
bool cross(const Face& a, const Face& b);

/// Whether a unit direction leaves a triangle on its outside, within 60 degrees of its normal: of the faces
/// of an edge whose normals are up to 120 degrees apart one at least has each direction between them, and
/// what slides along the inside is not taken for outside by rounding.
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

/// Collects the places of one pair of triangles.
struct PairPlaces {
  double reach_m;
  bool object_is_closed;
  bool scene_is_one_sided;
  Touched kind;
  const Eigen::Isometry3d& T_world_frame;
  std::vector<NearPoint>& found;

  /// Returns whether the triangles cross.
  bool look(const FrameTriangle& object, const FrameTriangle& scene) const;

 private:
  /// Nothing without a normal, nor inside of what is met from its outside only.
  void add(const Eigen::Vector3d& on_scene, const Eigen::Vector3d& normal, double gap_m, const Face& s) const;
  /// The scene's normal on the side of an object's corner that is so high above it; zero where none can be
  /// told.
  /// @param heights  of all corners of the object's triangle
  [[nodiscard]] Eigen::Vector3d off_scene(double height_m, const Face& o, const Face& s,
                                          const Range& heights) const;
  /// The object's normal from a scene's corner that is so high above it, to the object; zero likewise.
  /// @param heights  of all corners of the scene's triangle
  [[nodiscard]] Eigen::Vector3d off_object(double height_m, const Eigen::Vector3d& corner, const Face& o,
                                           const Range& heights) const;
  void look_at_edges(const Face& o, std::size_t i, const Face& s, std::size_t j) const;
};

/// Of many places those that hold up most: for each of some normals the nearest, and in each direction across
/// the normal the outermost, where a place that is farther away has to be farther out. `all` is used up.
void keep_the_outermost(std::vector<NearPoint>& all, std::vector<NearPoint>& kept);

}  // namespace roomradar
