// column_search.hpp: finds the object triangles that overlap a scene triangle in projection along the motion.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "radar/geometry/triangle_gap.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// Triangle tree of the object, rotated into the frame of the motion. The frame's origin is the tree's
/// centre. Its z axis is the direction of motion. Unit: m.
struct TurnedTree {
  const TriangleTree* tree = nullptr;
  Eigen::Matrix3d R_frame_mesh = Eigen::Matrix3d::Identity();
  double margin_m = 0.0;    ///< distance by which the search inflates boxes on all sides
  double touching_m = 0.0;  ///< distance below which surfaces touch; see classify_pair()
};

/// Returns an object triangle in the frame of the motion, with a zero normal.
inline FrameTriangle turned_corners(const TurnedTree& object, std::uint32_t triangle) {
  FrameTriangle result;
  const Triangle& t = object.tree->triangles()[triangle];
  for (std::size_t i = 0; i < 3; ++i) {
    result.corners[i] =
        object.R_frame_mesh * (object.tree->vertices()[t[i]].cast<double>() - object.tree->centre());
  }
  result.normal.setZero();
  return result;
}
inline FrameTriangle turned_triangle(const TurnedTree& object, std::uint32_t triangle) {
  FrameTriangle result = turned_corners(object, triangle);
  set_normal(result);
  return result;
}

/// Range of a linear function f(p) = g . p over each of a node's eight boxes. Over box i, f lies in value[i]
/// +- reach[i].
struct LinearOverBoxes {
  alignas(32) std::array<float, TreeNode::kWidth> value, reach;
};
inline void linear_over_boxes(const TreeNode& node, const Eigen::Vector3f& g, LinearOverBoxes& out) {
  const float gx = g.x(), gy = g.y(), gz = g.z();
  const float ax = std::abs(gx), ay = std::abs(gy), az = std::abs(gz);
  for (std::size_t i = 0; i < TreeNode::kWidth; ++i) {
    out.value[i] = gx * node.centre_x[i] + gy * node.centre_y[i] + gz * node.centre_z[i];
    out.reach[i] = ax * node.half_x[i] + ay * node.half_y[i] + az * node.half_z[i];
  }
}

/// Inner node (count = 0) or leaf (count > 0) that is left to visit. low_m is a lower bound of the gap from
/// the node's triangles to the scene triangle, along the motion. first and count are as in TreeNode.
struct PendingNode {
  float low_m;
  std::uint32_t first, count;
};

/// Scratch memory for searches, and a counter of their cost.
struct ColumnScratch {
  std::vector<PendingNode> pending;
  /// Number of nodes visited plus number of triangles passed to `leaf`. Each takes about 0.1 us. Accumulates
  /// over searches.
  std::uint64_t work = 0;
};

/// Sorts the nodes from index `first` on by descending low_m, so the node with the smallest gap is popped
/// next. Uses insertion sort for the at most eight children of one node.
inline void put_nearest_last(std::vector<PendingNode>& pending, std::size_t first) {
  for (std::size_t i = first + 1; i < pending.size(); ++i) {
    for (std::size_t j = i; j > first && pending[j].low_m > pending[j - 1].low_m; --j) {
      std::swap(pending[j], pending[j - 1]);
    }
  }
}

/// Infinite prism of a scene triangle along the motion. x_axis, y_axis, z_axis, edge and plane are used as
/// dot products with a point p of the object. p is in the mesh frame, relative to the tree's centre, in m.
/// All bounds include float rounding.
struct SceneColumn {
  Eigen::Vector3f x_axis, y_axis, z_axis;
  /// Bounds of the scene triangle in the frame of the motion, m. z0 and z1 are infinite unless is_steep.
  float x0, x1, y0, y1, z0, z1;
  /// Outward direction perpendicular to the projected triangle's longest edge. Points p with edge . p >
  /// edge_reach are beyond this edge and so outside the projected triangle.
  Eigen::Vector3f edge;
  float edge_reach;
  /// Height of the triangle's plane above a point p along the motion: offset + plane . p, within +-
  /// plane_slack. If is_edge_on, offset + plane . p is the signed distance of p from the plane instead. A box
  /// whose distance from the plane exceeds -beside counts as not crossing the plane.
  Eigen::Vector3f plane = Eigen::Vector3f::Zero();
  float offset = 0.0F, plane_slack = std::numeric_limits<float>::infinity();
  float beside = -std::numeric_limits<float>::infinity();
  bool is_edge_on = false;
  /// True if the plane is nearly parallel to the motion. Then the triangle's z range bounds the gap as well.
  bool is_steep = true;

  SceneColumn(const TurnedTree& object, const FrameTriangle& scene);

  /// Returns a lower bound of the gap from an object triangle to the scene triangle's plane, along the
  /// motion. Returns -infinity if the scene triangle is edge-on or has no area.
  [[nodiscard]] float least_gap(const TriangleTree& tree, std::uint32_t triangle) const {
    if (is_edge_on) return -std::numeric_limits<float>::infinity();
    const Eigen::Vector3f centre = tree.centre().cast<float>();
    float least = std::numeric_limits<float>::infinity();
    for (const std::uint32_t v : tree.triangles()[triangle]) {
      least = std::min(least, plane.dot(tree.vertices()[v] - centre));
    }
    return offset + least - plane_slack;
  }
};

/// Visits the object triangles that may overlap `scene` in projection along the motion, in order of their
/// smallest possible gap. The gap is the height of the scene's surface above the object's, along the motion.
///
/// The gap between the scene triangle's plane and a point is linear in the point, so its minimum and maximum
/// over a box are exact. If the plane is steep, the z ranges of box and triangle bound the gap as well. All
/// bounds include float rounding. If the scene triangle is edge-on, the search keeps only boxes that extend
/// beyond its plane on both sides by touching_m minus rounding. Triangles in other boxes can only slide along
/// the plane (see classify_pair()).
///
/// Bounds and tests are in one function, so the eight lanes of a node stay in registers.
///
/// @param limit_m   callable without arguments that returns a gap. The search skips boxes and triangles whose
///                  min gap is not below it
/// @param floor_m   the search skips boxes whose max gap is less than floor_m
/// @param leaf      callable that takes the index of an object triangle
/// @return true if the search skipped a box because its max gap is less than floor_m (the scene triangle is
///         behind the box)
template <typename Limit, typename Leaf>
bool search_column(const TurnedTree& object, const FrameTriangle& scene, const Limit& limit_m, double floor_m,
                   ColumnScratch& scratch, const Leaf& leaf) {
  std::vector<PendingNode>& pending = scratch.pending;
  const TriangleTree& tree = *object.tree;
  const SceneColumn column(object, scene);
  constexpr float kRounding = 16.0F * std::numeric_limits<float>::epsilon();
  const auto limit_above = [&] {
    return static_cast<float>(limit_m()) * (1.0F + kRounding) + std::numeric_limits<float>::min();
  };
  const auto floor = static_cast<float>(floor_m);
  bool has_passed = false;
  LinearOverBoxes x, y, z{}, edge, gap;
  pending.clear();
  pending.push_back({-std::numeric_limits<float>::infinity(), 0, 0});
  while (!pending.empty()) {
    const PendingNode next = pending.back();
    pending.pop_back();
    const float limit = limit_above();
    if (!(next.low_m < limit)) continue;
    if (next.count > 0) {
      for (std::uint32_t i = next.first; i < next.first + next.count; ++i) {
        if (column.least_gap(tree, i) >= limit_above()) continue;
        ++scratch.work;
        leaf(i);
      }
      continue;
    }
    ++scratch.work;
    const TreeNode& node = tree.nodes()[next.first];
    linear_over_boxes(node, column.x_axis, x);
    linear_over_boxes(node, column.y_axis, y);
    linear_over_boxes(node, column.edge, edge);
    linear_over_boxes(node, column.plane, gap);
    if (column.is_steep) linear_over_boxes(node, column.z_axis, z);
    // Branch-free, so compilers vectorise the eight lanes.
    alignas(32) std::array<float, TreeNode::kWidth> low_m, high_m, apart;
    for (std::size_t i = 0; i < TreeNode::kWidth; ++i) {
      const float plane_at = column.offset + gap.value[i];
      const float beside = std::max(plane_at, -plane_at) - gap.reach[i] + column.beside;
      const float outside_x = std::max(x.value[i] - column.x1, column.x0 - x.value[i]) - x.reach[i];
      const float outside_y = std::max(y.value[i] - column.y1, column.y0 - y.value[i]) - y.reach[i];
      const float outside_edge = edge.value[i] - edge.reach[i] - column.edge_reach;
      apart[i] = std::max(std::max(outside_x, outside_y), std::max(outside_edge, beside));
      const float plane_low = plane_at - gap.reach[i] - column.plane_slack;
      const float plane_high = plane_at + gap.reach[i] + column.plane_slack;
      const float box_low = column.z0 - z.value[i] - z.reach[i];
      const float box_high = column.z1 - z.value[i] + z.reach[i];
      low_m[i] = std::max(plane_low, box_low);
      high_m[i] = std::min(plane_high, box_high);
    }
    const std::size_t first_new = pending.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      if (apart[i] > 0.0F || !(low_m[i] < limit)) continue;
      if (high_m[i] < floor) {
        has_passed = true;
        continue;
      }
      pending.push_back({low_m[i], node.first[i], node.count[i]});
    }
    put_nearest_last(pending, first_new);
  }
  return has_passed;
}

}  // namespace roomradar
