// local_surface.cpp: searches the tree about a point; second moments of the triangles inside a cube.
#include "radar/motion/local_surface.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "radar/geometry/inflated_distance.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {
namespace {

using Vec3 = Eigen::Vector3d;

/// A convex polygon: a triangle with up to six of its parts cut off.
struct Polygon {
  std::array<Vec3, 9> corners;
  std::size_t count = 0;
};

/// Cuts off what lies beyond a coordinate's limit.
void cut(Polygon& polygon, int axis, double side, double limit) {
  Polygon kept;
  for (std::size_t i = 0; i < polygon.count; ++i) {
    const Vec3 &a = polygon.corners[i], &b = polygon.corners[(i + 1) % polygon.count];
    const double a_in = limit - side * a[axis], b_in = limit - side * b[axis];
    if (a_in >= 0.0) kept.corners[kept.count++] = a;
    if ((a_in >= 0.0) != (b_in >= 0.0)) kept.corners[kept.count++] = a + a_in / (a_in - b_in) * (b - a);
  }
  polygon = kept;
}

/// Area, and first and second moments of area.
struct Moments {
  double area_m2 = 0.0;
  Vec3 first_m3 = Vec3::Zero();
  Eigen::Matrix3d second_m4 = Eigen::Matrix3d::Zero();

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Vec3 sum = a + b + c;
    area_m2 += area;
    first_m3 += area / 3.0 * sum;
    second_m4 +=
        area / 12.0 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
};

/// Calls visit(triangle) for the triangles of the tree's leaves that reach into a cube about a local point.
template <typename Visit>
void visit_triangles_near(const TriangleTree& tree, const Vec3& local_point, double reach_m,
                          const Visit& visit) {
  const Eigen::Array3f middle = (local_point - tree.centre()).cast<float>();
  const float slack_m = static_cast<float>(reach_m) + tree.rounding_m();
  std::array<std::uint32_t, 256> pending;  // the hierarchy is far less than 256 / 8 levels deep
  std::size_t count = 0;
  pending[count++] = 0;
  while (count > 0) {
    const TreeNode& node = tree.nodes()[pending[--count]];
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      const Eigen::Array3f centre(node.centre_x[i], node.centre_y[i], node.centre_z[i]);
      const Eigen::Array3f half(node.half_x[i], node.half_y[i], node.half_z[i]);
      if (((centre - middle).abs() > half + slack_m).any()) continue;
      if (node.count[i] == 0) {
        if (count < pending.size()) pending[count++] = node.first[i];
        continue;
      }
      for (std::uint32_t t = node.first[i]; t < node.first[i] + node.count[i]; ++t)
        visit(tree.triangles()[t]);
    }
  }
}

}  // namespace

std::optional<Vec3> nearest_point(const TreeInstance& surface, const Vec3& point_world, double reach_m) {
  const TriangleTree& tree = *surface.tree;
  if (tree.empty()) return {};
  const Vec3 local_point = surface.T_world_mesh.inverse() * point_world - tree.origin();
  const FrameTriangle point{{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}, Vec3::Zero()};
  std::optional<Vec3> nearest;
  visit_triangles_near(tree, local_point, reach_m, [&](const Triangle& triangle) {
    FrameTriangle t;
    for (std::size_t k = 0; k < 3; ++k)
      t.corners[k] = tree.vertices()[triangle[k]].cast<double>() - local_point;
    set_normal(t);
    const Vec3 way = shortest_way(point, t, 0.0).way;
    if (!(way.norm() < reach_m)) return;
    reach_m = way.norm();
    nearest = way;
  });
  if (nearest) *nearest = point_world + surface.T_world_mesh.linear() * *nearest;
  return nearest;
}

FittedPlane fit_plane(const TreeInstance& surface, const Vec3& point_world, const Vec3& facing_world,
                      double reach_m) {
  constexpr double kFacing = 0.5;  // cosine of 60 degrees
  const TriangleTree& tree = *surface.tree;
  if (tree.empty()) return {};
  const Vec3 local_point = surface.T_world_mesh.inverse() * point_world - tree.origin();
  const Vec3 facing = surface.T_world_mesh.linear().transpose() * facing_world;
  Moments moments;
  visit_triangles_near(tree, local_point, reach_m, [&](const Triangle& triangle) {
    Polygon part;
    part.count = 3;
    for (std::size_t k = 0; k < 3; ++k)
      part.corners[k] = tree.vertices()[triangle[k]].cast<double>() - local_point;
    const Vec3 area = (part.corners[1] - part.corners[0]).cross(part.corners[2] - part.corners[0]);
    if (!(std::abs(area.dot(facing)) > kFacing * area.norm())) return;
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {1.0, -1.0}) {
        double most_m = -reach_m;
        for (std::size_t k = 0; k < part.count; ++k) most_m = std::max(most_m, side * part.corners[k][axis]);
        if (most_m > reach_m) cut(part, axis, side, reach_m);
      }
    for (std::size_t i = 2; i < part.count; ++i)
      moments.add(part.corners[0], part.corners[i - 1], part.corners[i]);
  });
  if (!(moments.area_m2 > 0.0)) return {};
  const Vec3 mean = moments.first_m3 / moments.area_m2;
  const Eigen::Matrix3d covariance = moments.second_m4 / moments.area_m2 - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes;
  axes.compute(covariance);
  const Vec3 normal = axes.eigenvectors().col(0);
  const Vec3 normal_world =
      surface.T_world_mesh.linear() * (normal.dot(facing) < 0.0 ? Vec3(-normal) : normal);
  return {normal_world, point_world + surface.T_world_mesh.linear() * mean,
          std::sqrt(std::max(axes.eigenvalues()[0], 0.0)), std::sqrt(std::max(axes.eigenvalues()[1], 0.0))};
}

}  // namespace roomradar
