// solid_inside.cpp: counts the crossings ahead of a point.
#include "radar/geometry/solid_inside.hpp"

namespace roomradar {
namespace {

FrameTriangle at_point(const Eigen::Vector3d& p) { return {{p, p, p}, Eigen::Vector3d::Zero()}; }

/// Returns the distance from a point to a triangle. Source: Ericson, Real-Time Collision Detection, 2005,
/// section 5.1.5: to the plane if the point is over the face, else to the nearest edge.
double distance_to(const FrameTriangle& t, const Eigen::Vector3d& p) {
  const auto& c = t.corners;
  bool is_over_face = !t.normal.isZero(0.0);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = c[(i + 1) % 3] - c[i], to_p = p - c[i];
    if (t.normal.dot(edge.cross(to_p)) < 0.0) is_over_face = false;
    const double length2 = edge.squaredNorm();
    const double along = length2 > 0.0 ? std::clamp(edge.dot(to_p) / length2, 0.0, 1.0) : 0.0;
    nearest = std::min(nearest, (to_p - along * edge).norm());
  }
  return is_over_face ? std::abs(t.normal.dot(p - c[0])) : nearest;
}

bool is_near_surface(const TurnedTree& object, const Eigen::Vector3d& p, ColumnScratch& scratch) {
  TurnedTree thick = object;
  thick.margin_m = object.touching_m;
  bool is_near = false;
  search_column(
      thick, at_point(p), [&] { return is_near ? -1e30 : object.touching_m; }, -object.touching_m, scratch,
      [&](std::uint32_t i) {
        is_near = is_near || distance_to(turned_triangle(object, i), p) <= object.touching_m;
      });
  return is_near;
}

}  // namespace

Eigen::Vector3d inner_point(const FrameTriangle& triangle, int which) {
  // Barycentric weights in an irregular pattern, which meshes do not share.
  constexpr std::array<std::array<double, 2>, 5> kWeights{
      {{0.3141, 0.3585}, {0.6127, 0.2713}, {0.1919, 0.1733}, {0.1339, 0.5501}, {0.4447, 0.1031}}};
  const auto& w = kWeights[static_cast<std::size_t>(which) % kWeights.size()];
  const auto& c = triangle.corners;
  return c[0] + w[0] * (c[1] - c[0]) + w[1] * (c[2] - c[0]);
}

bool layers_at(const TurnedTree& object, const Eigen::Vector3d& point, double limit_m, ColumnScratch& scratch,
               std::vector<Layer>& layers) {
  layers.clear();
  bool is_sure = true;
  search_column(
      object, at_point(point), [&] { return limit_m; }, -std::numeric_limits<double>::infinity(), scratch,
      [&](std::uint32_t i) {
        const FrameTriangle t = turned_triangle(object, i);
        const auto& c = t.corners;
        std::array<double, 3> w;
        double size2 = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
          const Eigen::Vector3d a = c[(k + 1) % 3] - point, b = c[(k + 2) % 3] - point;
          w[k] = a.x() * b.y() - a.y() * b.x();
          size2 = std::max({size2, a.head<2>().squaredNorm(), b.head<2>().squaredNorm()});
        }
        const double rounding = 1e-14 * size2;
        const bool is_left = w[0] > rounding && w[1] > rounding && w[2] > rounding;
        const bool is_right = w[0] < -rounding && w[1] < -rounding && w[2] < -rounding;
        if (is_left || is_right) {
          const double z = (w[0] * c[0].z() + w[1] * c[1].z() + w[2] * c[2].z()) / (w[0] + w[1] + w[2]);
          layers.push_back({point.z() - z, is_left ? 1 : -1});
        } else {
          const bool is_outside = (w[0] > rounding || w[1] > rounding || w[2] > rounding) &&
                                  (w[0] < -rounding || w[1] < -rounding || w[2] < -rounding);
          is_sure = is_sure && is_outside;
        }
      });
  return is_sure;
}

bool is_within(const std::vector<Layer>& layers, double contact_distance_m) {
  int ways_out = 0;
  for (const Layer& layer : layers) ways_out += layer.gap_m < contact_distance_m ? layer.way_out : 0;
  return ways_out > 0;
}

bool is_inside(const TurnedTree& object, const FrameTriangle& scene, ColumnScratch& scratch,
               std::vector<Layer>& layers) {
  if (!object.tree->is_closed()) return false;
  for (int which = 0; which < 5; ++which) {
    const Eigen::Vector3d point = inner_point(scene, which);
    if (!layers_at(object, point, 0.0, scratch, layers)) continue;
    if (!is_within(layers, 0.0)) return false;
    if (!is_near_surface(object, point, scratch)) return true;
  }
  return false;
}

}  // namespace roomradar
