// column_search.hpp: which of an object's triangles does a scene triangle have in its column along the
// motion?
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "radar/triangle_gap.hpp"
#include "radar/triangle_tree.hpp"

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

/// Sorts the nodes from `first` on, so that the nearest is the next. A handful: the children of one node.
inline void put_nearest_last(std::vector<PendingNode>& pending, std::size_t first) {
  for (std::size_t i = first + 1; i < pending.size(); ++i) {
    for (std::size_t j = i; j > first && pending[j].low_m > pending[j - 1].low_m; --j) {
      std::swap(pending[j], pending[j - 1]);
    }
  }
}

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
/// @param pending   scratch
/// @return whether a box was passed over because it lies ahead of the scene by more than -floor_m
template <typename Limit, typename Leaf>
bool search_column(const TurnedTree& object, const FrameTriangle& scene, const Limit& limit_m, double floor_m,
                   std::vector<PendingNode>& pending, const Leaf& leaf) {
  const TriangleTree& tree = *object.tree;
  const Eigen::Matrix3f R = object.R_frame_mesh.cast<float>();
  Eigen::Vector3d low = scene.corners[0], high = scene.corners[0];
  for (const Eigen::Vector3d& corner : scene.corners) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  constexpr float kRounding = 16.0F * std::numeric_limits<float>::epsilon();
  const float size_m = tree.half_size().sum();
  const auto margin_m = static_cast<float>(object.margin_m) * (1.0F + kRounding);
  const float slack_m = kRounding * size_m + margin_m;
  const auto near_m = static_cast<float>(low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff());
  const float far_slack_m = slack_m + kRounding * near_m;
  const float x0 = static_cast<float>(low.x()) - far_slack_m, x1 = static_cast<float>(high.x()) + far_slack_m;
  const float y0 = static_cast<float>(low.y()) - far_slack_m, y1 = static_cast<float>(high.y()) + far_slack_m;
  const float z0 = static_cast<float>(low.z()) - far_slack_m, z1 = static_cast<float>(high.z()) + far_slack_m;

  // Height of the scene's plane above a point: offset + g . p.
  Eigen::Vector3f g = Eigen::Vector3f::Zero();
  float offset_m = 0.0F, plane_slack_m = std::numeric_limits<float>::infinity();
  const bool is_edge_on = std::abs(scene.normal.z()) <= kEdgeOn && !scene.normal.isZero(0.0);
  if (std::abs(scene.normal.z()) > kEdgeOn) {
    const Eigen::Vector3d in_frame(-scene.normal.x() / scene.normal.z(), -scene.normal.y() / scene.normal.z(),
                                   -1.0);
    const double offset = scene.normal.dot(scene.corners[0]) / scene.normal.z();
    g = (object.R_frame_mesh.transpose() * in_frame).cast<float>();
    offset_m = static_cast<float>(offset);
    const float slope = g.cwiseAbs().sum();
    plane_slack_m = kRounding * (slope * (size_m + near_m) + std::abs(offset_m)) + slope * margin_m;
  }
  // Seen edge-on: distance from the scene's plane instead; what does not reach through it is slid along.
  float beside_m = 0.0F;
  if (is_edge_on) {
    g = (object.R_frame_mesh.transpose() * scene.normal).cast<float>();
    offset_m = static_cast<float>(-scene.normal.dot(scene.corners[0]));
    beside_m = static_cast<float>(object.touching_m) - 2.0F * far_slack_m - kRounding * std::abs(offset_m);
  }
  const Eigen::Vector3f x_axis = R.row(0), y_axis = R.row(1), z_axis = R.row(2);

  const auto floor = static_cast<float>(floor_m);
  bool has_passed = false;
  pending.clear();
  pending.push_back({-std::numeric_limits<float>::infinity(), 0, 0});
  while (!pending.empty()) {
    const PendingNode next = pending.back();
    pending.pop_back();
    if (!(next.low_m < limit_m())) continue;
    if (next.count > 0) {
      for (std::uint32_t i = next.first; i < next.first + next.count; ++i) leaf(i);
      continue;
    }
    const TreeNode& node = tree.nodes()[next.first];
    LinearOverBoxes x, y, z, gap;
    linear_over_boxes(node, x_axis, x);
    linear_over_boxes(node, y_axis, y);
    linear_over_boxes(node, z_axis, z);
    linear_over_boxes(node, g, gap);
    alignas(32) std::array<float, TreeNode::kWidth> low_m, high_m;
    for (std::size_t i = 0; i < TreeNode::kWidth; ++i) {
      const float across =
          std::max(gap.value[i] + offset_m - gap.reach[i], -gap.value[i] - offset_m - gap.reach[i]);
      const float beside = is_edge_on ? across + beside_m : -1.0F;
      const float outside = std::max(std::max(x.value[i] - x.reach[i] - x1, x0 - x.value[i] - x.reach[i]),
                                     std::max(y.value[i] - y.reach[i] - y1, y0 - y.value[i] - y.reach[i]));
      const float apart = std::max(outside, beside);
      const float plane_low = offset_m + gap.value[i] - gap.reach[i] - plane_slack_m;
      const float plane_high = offset_m + gap.value[i] + gap.reach[i] + plane_slack_m;
      const float box_low = z0 - z.value[i] - z.reach[i];
      const float box_high = z1 - z.value[i] + z.reach[i];
      const float low_i = std::max(plane_low, box_low);
      low_m[i] = apart > 0.0F ? std::numeric_limits<float>::infinity() : low_i;
      high_m[i] = std::min(plane_high, box_high);
    }
    const auto limit = static_cast<float>(limit_m()) * (1.0F + kRounding) + std::numeric_limits<float>::min();
    const std::size_t first_new = pending.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      if (!(low_m[i] < limit)) continue;
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
