// nearest_triangle.cpp: point-to-triangle distances over the chunks nearby.
#include "radar/nearest_triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roomradar {
namespace {

/// Point of the triangle nearest to p.
/// Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
Eigen::Vector3d closest_point(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0];
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return t[0];
  const Eigen::Vector3d bp = p - t[1];
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return t[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return t[0] + ab * (d1 / (d1 - d3));
  const Eigen::Vector3d cp = p - t[2];
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return t[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return t[0] + ac * (d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 >= d3 && d5 >= d6) return t[1] + (t[2] - t[1]) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const double scale = 1.0 / (va + vb + vc);
  return t[0] + ab * (vb * scale) + ac * (vc * scale);
}

}  // namespace

std::optional<NearestTriangle> nearest_triangle(const MeshInstance& instance, const Eigen::Vector3d& p_world,
                                                const Eigen::Vector3d& u_world, double within_m) {
  const GpuMesh& mesh = *instance.mesh;
  const Eigen::Vector3d p = instance.T_world_mesh.inverse() * p_world - mesh.origin();
  const Eigen::Vector3d u = instance.T_world_mesh.linear().transpose() * u_world;
  constexpr double kEquallyNear_m = 1e-7;  // what float vertices at a metre can tell apart
  double best_m = within_m;
  double best_facing = 2.0;
  Eigen::Vector3d best_normal = Eigen::Vector3d::Zero();
  for (const MeshChunk& chunk : mesh.chunks()) {
    const Eigen::AlignedBox3d box = chunk.bounds_local.cast<double>();
    if (box.exteriorDistance(p) > best_m + kEquallyNear_m) continue;
    for (const Triangle& triangle : mesh.triangles().subspan(chunk.first_triangle, chunk.triangle_count)) {
      std::array<Eigen::Vector3d, 3> corners;
      Eigen::AlignedBox3d triangle_box;
      for (std::size_t i = 0; i < 3; ++i) {
        corners[i] = mesh.vertices()[triangle[i]].cast<double>();
        triangle_box.extend(corners[i]);
      }
      if (triangle_box.exteriorDistance(p) > best_m + kEquallyNear_m) continue;
      const Eigen::Vector3d across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
      const double area = across.norm();
      if (!(area > 0.0)) continue;
      const double distance_m = (closest_point(p, corners) - p).norm();
      const double facing = across.dot(u) / area;
      const bool nearer = distance_m < best_m - kEquallyNear_m;
      const bool as_near = distance_m <= best_m + kEquallyNear_m;
      if (!nearer && !(as_near && facing < best_facing)) continue;
      best_m = std::min(best_m, distance_m);
      best_facing = facing;
      best_normal = across / area;
    }
  }
  if (best_facing > 1.5) return std::nullopt;
  return NearestTriangle{best_m, (instance.T_world_mesh.linear() * best_normal).normalized()};
}

}  // namespace roomradar
