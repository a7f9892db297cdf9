// near_places.hpp: where two triangles are near each other, and which of many such places hold up most.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <vector>

#include "radar/near_field.hpp"
#include "radar/triangle_gap.hpp"

namespace roomradar {

/// With what is asked of it again and again.
struct Face : FrameTriangle {
  std::array<Eigen::Vector3d, 3> edge, inward;  ///< from corner i on, and across it towards the third corner
};

Face face_of(const FrameTriangle& triangle);
/// Whether an edge of the one goes through the other.
bool cross(const Face& a, const Face& b);

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
};
inline Range range_along(const Eigen::Vector3d& direction, const std::array<Eigen::Vector3d, 3>& corners) {
  Range range;
  for (const Eigen::Vector3d& corner : corners) {
    const double at = direction.dot(corner);
    range.low = std::min(range.low, at);
    range.high = std::max(range.high, at);
  }
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
  bool look(const Face& o, const Face& s) const;

 private:
  void add(const Eigen::Vector3d& on_scene, const Eigen::Vector3d& way, double gap_m) const;
  void look_at_edges(const Face& o, std::size_t i, const Face& s, std::size_t j) const;
};

/// Of many places those that hold up most: for each of some normals the nearest, and in each direction across
/// the normal the outermost, where a place that is farther away has to be farther out. `all` is used up.
void keep_the_outermost(std::vector<NearPoint>& all, std::vector<NearPoint>& kept);

}  // namespace roomradar
