// turned_bounds.cpp: the farthest vertex per direction, by branch and bound.
#include "radar/exact/turned_bounds.hpp"

#include <algorithm>
#include <cstdint>

#include "radar/geometry/infinity.hpp"

namespace roomradar {
namespace {

/// Returns the greatest value of g . p over the tree's used vertices, or up to tolerance_m more. The
/// tolerance saves time, since many vertices are nearly as far out.
double support(const TriangleTree& tree, const Eigen::Vector3d& g, double tolerance_m,
               std::vector<PendingNode>& pending) {
  const Eigen::Vector3f direction = g.cast<float>();
  const float slack_m = kHeightRounding * tree.half_size().sum();
  double best = -std::numeric_limits<double>::infinity(), passed = best;
  pending.clear();
  pending.push_back({-kInfinity<float>, 0, 0});  // low_m: minus an upper bound of the values below
  while (!pending.empty()) {
    const PendingNode next = pending.back();
    pending.pop_back();
    if (!(-next.low_m > best + tolerance_m)) {
      passed = std::max(passed, -static_cast<double>(next.low_m));
      continue;
    }
    if (next.count > 0) {
      for (std::uint32_t t = next.first; t < next.first + next.count; ++t) {
        for (const std::uint32_t v : tree.triangles()[t]) {
          best = std::max(best, g.dot(tree.vertices()[v].cast<double>() - tree.centre()));
        }
      }
      continue;
    }
    const TreeNode& node = tree.nodes()[next.first];
    LinearOverBoxes f;
    linear_over_boxes(node, direction, f);
    const std::size_t first_new = pending.size();
    for (std::uint32_t i = 0; i < node.child_count; ++i) {
      pending.push_back({-(f.value[i] + f.reach[i] + slack_m), node.first[i], node.count[i]});
    }
    put_nearest_last(pending, first_new);
  }
  return std::max(best, std::min(passed, best + tolerance_m));
}

}  // namespace

Eigen::AlignedBox3d turned_bounds(const TurnedTree& object, double tolerance_m,
                                  std::vector<PendingNode>& pending) {
  const double slack_m = 1e-15 * object.tree->half_size().cast<double>().sum() + object.margin_m;
  Eigen::Vector3d low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d g = object.R_frame_mesh.row(axis);
    high[axis] = support(*object.tree, g, tolerance_m, pending) + slack_m;
    low[axis] = -support(*object.tree, -g, tolerance_m, pending) - slack_m;
  }
  return {low, high};
}

}  // namespace roomradar
