// ray_hit.cpp: traverses the tree of boxes, pruned by the nearest hit so far.
#include "radar/exact/ray_hit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

/// Returns t > 0 at which origin + t * direction hits the triangle; infinite if it misses.
double classify_pair(const Vec3& origin, const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const Vec3 ab = b - a, ac = c - a;
  const Vec3 across = direction.cross(ac);
  const double determinant = ab.dot(across);
  if (determinant == 0.0) return kMiss;
  const Vec3 from_a = origin - a;
  const double u = from_a.dot(across) / determinant;
  const Vec3 turned = from_a.cross(ab);
  const double v = direction.dot(turned) / determinant;
  const double t = ac.dot(turned) / determinant;
  constexpr double kRounding = 1e-9;  // no ray slips between two triangles
  return u >= -kRounding && v >= -kRounding && u + v <= 1.0 + kRounding && t > 0.0 ? t : kMiss;
}

}  // namespace

Ray ray_through(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, double u_px, double v_px) {
  return {T_world_camera.translation(),
          (T_world_camera.linear() * back_project(camera, u_px, v_px, 1.0)).normalized()};
}

std::optional<MeshHit> hit_mesh(const TreeInstance& mesh, const Ray& ray, double reach_m) {
  if (mesh.tree == nullptr || mesh.tree->empty()) return std::nullopt;
  const TriangleTree& tree = *mesh.tree;
  const Eigen::Isometry3d T_mesh_world = mesh.T_world_mesh.inverse();
  const Vec3 origin = T_mesh_world * ray.origin_world - tree.origin();  // in the vertices' frame
  const Vec3 direction = T_mesh_world.linear() * ray.direction_world;
  if (!origin.allFinite() || !direction.allFinite() || direction.isZero()) return std::nullopt;
  const Vec3 from_centre = origin - tree.centre();

  double best_m = reach_m;
  Vec3 normal = Vec3::Zero();
  const auto enters_within = [&](const TreeNode& node, std::uint32_t child) {
    const auto i = static_cast<std::size_t>(child);
    const Vec3 centre(node.centre_x[i], node.centre_y[i], node.centre_z[i]);
    const Vec3 half(node.half_x[i], node.half_y[i], node.half_z[i]);
    double near_m = 0.0, far_m = best_m;
    for (int axis = 0; axis < 3; ++axis) {
      const double to_centre = centre[axis] - from_centre[axis];
      if (direction[axis] == 0.0) {
        if (std::abs(to_centre) > half[axis]) return false;
        continue;
      }
      const double a = (to_centre - half[axis]) / direction[axis];
      const double b = (to_centre + half[axis]) / direction[axis];
      near_m = std::max(near_m, std::min(a, b));
      far_m = std::min(far_m, std::max(a, b));
    }
    return near_m <= far_m;
  };
  std::vector<std::uint32_t> open{0};
  while (!open.empty()) {
    const TreeNode& node = tree.nodes()[open.back()];
    open.pop_back();
    for (std::uint32_t child = 0; child < node.child_count; ++child) {
      if (!enters_within(node, child)) continue;
      const std::uint32_t first = node.first[child], count = node.count[child];
      if (count == 0) open.push_back(first);
      for (std::uint32_t i = first; i < first + count; ++i) {
        const Triangle& triangle = tree.triangles()[i];
        const Vec3 a = tree.vertices()[triangle[0]].cast<double>();
        const Vec3 b = tree.vertices()[triangle[1]].cast<double>();
        const Vec3 c = tree.vertices()[triangle[2]].cast<double>();
        const double t = classify_pair(origin, direction, a, b, c);
        if (!(t < best_m)) continue;
        best_m = t;
        normal = (b - a).cross(c - a);
      }
    }
  }
  if (normal.isZero()) return std::nullopt;
  MeshHit hit;
  hit.distance_m = best_m;
  hit.point_world = ray.origin_world + best_m * ray.direction_world;
  hit.normal_world = (mesh.T_world_mesh.linear() * normal).normalized();
  if (hit.normal_world.dot(ray.direction_world) > 0.0) hit.normal_world = -hit.normal_world;
  return hit;
}

}  // namespace roomradar
