// column_search.hpp: which of an object's triangles does a scene triangle have in its column along the
// motion?
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "radar/geometry/triangle_gap.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// A tree seen in the frame of a motion: origin at the tree's centre, z along the direction, m.
struct TurnedTree {
  const TriangleTree* tree = nullptr;
  Eigen::Matrix3d R_frame_mesh = Eigen::Matrix3d::Identity();
  double margin_m = 0.0;    ///< boxes are taken as larger by this
  double touching_m = 0.0;  ///< closer surfaces touch: see meeting_of()
};

/// Without its normal.
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

/// Eight linear functions at a time: f(p) = g . p over each box is value +- reach.
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

/// A node waiting to be looked into, and the least gap that it can hold.
struct PendingNode {
  float low_m;
  std::uint32_t first, count;
};

/// Scratch of searches, and how much they did.
struct ColumnScratch {
  std::vector<PendingNode> pending;
  std::uint64_t work = 0;  ///< nodes looked into and triangles handed out, some 0.1 us each; grows
};

/// Sorts the nodes from `first` on, so that the nearest is the next. A handful: the children of one node.
inline void put_nearest_last(std::vector<PendingNode>& pending, std::size_t first) {
  for (std::size_t i = first + 1; i < pending.size(); ++i) {
    for (std::size_t j = i; j > first && pending[j].low_m > pending[j - 1].low_m; --j) {
      std::swap(pending[j], pending[j - 1]);
    }
  }
}

/// A scene triangle's column along the motion, as an object's tree is asked about it: linear functions of the
/// points of the object's mesh, relative to the tree's centre, with all rounding in float counted in.
struct SceneColumn {
  Eigen::Vector3f x_axis, y_axis, z_axis;
  float x0, x1, y0, y1, z0, z1;  ///< around the triangle, m
  /// Beyond the triangle's longest edge across the motion: edge . p > edge_reach.
  Eigen::Vector3f edge;
  float edge_reach;
  /// Height of the triangle's plane above a point: offset + plane . p, give or take plane_slack. Seen
  /// edge-on: the distance from its plane; what is farther from it than -beside does not reach through it.
  Eigen::Vector3f plane = Eigen::Vector3f::Zero();
  float offset = 0.0F, plane_slack = std::numeric_limits<float>::infinity();
  float beside = -std::numeric_limits<float>::infinity();
  bool is_edge_on = false;
  bool is_steep = true;  ///< heights say more than the plane, or as much

  SceneColumn(const TurnedTree& object, const FrameTriangle& scene);

  /// No gap between the triangle and this one of the object is less, whatever the triangle's outline.
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

/// Goes through the object's triangles that may share a place across the motion with `scene`, those that can
/// have the least gap first.
///
/// The gap between the scene triangle's plane and a point is linear in the point, so that its least and
/// greatest values over a box are exact; where the plane is steep the heights of both take over. Both hold
/// with all rounding in float counted in. For a scene triangle seen edge-on, boxes that do not reach through
/// its plane by touching_m are passed over: what is in them slides along it (see meeting_of()), if at all.
///
/// @param limit_m   called with nothing; what cannot have a gap under it is passed over
/// @param floor_m   what cannot have a gap of at least this is passed over
/// @param leaf      called with the object's triangle's number
/// @return whether a box was passed over because it lies ahead of the scene by more than -floor_m
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
    // Without branches, so that compilers make it eight at a time.
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
