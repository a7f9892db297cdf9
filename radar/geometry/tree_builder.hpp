// tree_builder.hpp: builds the nodes of a TriangleTree, spatially or in the given order of the triangles.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

/// Axis-aligned bounds in float, m; empty by default.
struct FloatBounds {
  Eigen::Array3f low = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
  Eigen::Array3f high = Eigen::Array3f::Constant(-std::numeric_limits<float>::infinity());
  void extend(const Eigen::Array3f& p) {
    low = low.min(p);
    high = high.max(p);
  }
  void extend(const FloatBounds& b) {
    low = low.min(b.low);
    high = high.max(b.high);
  }
  [[nodiscard]] float area() const {
    const Eigen::Array3f s = high - low;
    return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
  }
};

/// Returns the bounds of a triangle's vertices, without a margin for rounding.
FloatBounds bounds_of(const Triangle& triangle, const std::vector<Eigen::Vector3f>& vertices);

/// Frame of the nodes' boxes: boxes are relative to `centre` and enlarged by rounding_m on all sides.
struct NodeFrame {
  Eigen::Array3f centre;  // m
  float rounding_m;
};

/// Builds nodes with the surface area heuristic; see TriangleTree::build_by_place().
/// @param[out] nodes  the root is first, and children come after their parents
/// @return indices of the triangles, in the order in which the leaves refer to them
std::vector<std::uint32_t> build_nodes_by_place(const std::vector<Triangle>& triangles,
                                                const std::vector<Eigen::Vector3f>& vertices,
                                                const NodeFrame& frame, std::vector<TreeNode>& nodes);

/// Builds nodes over ranges of consecutive triangles; see TriangleTree::build_in_order(). Reuses the memory
/// of `nodes`.
void build_nodes_in_order(const std::vector<Triangle>& triangles,
                          const std::vector<Eigen::Vector3f>& vertices, const NodeFrame& frame,
                          std::vector<TreeNode>& nodes);

}  // namespace roomradar
