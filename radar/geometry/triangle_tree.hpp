// triangle_tree.hpp: a CPU mesh for exact queries, with an 8-wide tree of boxes over its triangles.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Eight boxes as a structure of arrays, for SIMD. Boxes are relative to TriangleTree::centre() and contain
/// everything under them, rounding included. Unused entries repeat the first box.
struct alignas(32) TreeNode {
  static constexpr int kWidth = 8;
  std::array<float, kWidth> centre_x, centre_y, centre_z;  // m
  std::array<float, kWidth> half_x, half_y, half_z;        // m
  std::array<std::uint32_t, kWidth> first;  // leaf: its first triangle; inner child: index in nodes()
  std::array<std::uint32_t, kWidth> count;  // leaf: number of triangles; inner child: 0
  std::uint32_t child_count = 0;
  std::uint32_t within_faces = 0;  // bit i: all triangles under box i lie within flat faces
};

/// A rigid mesh (a sensor object, a saved room) or a mesh of a single frame, on the CPU. Vertices are float,
/// relative to the mesh's own double origin, so precision does not suffer far from zero. Triangles with an
/// index past the last vertex or a vertex that is not finite are dropped and counted; degenerate and
/// duplicate ones stay. No GL. Reading is thread safe, building is not.
///
/// A triangle of a closed mesh is within a flat face if none of its edges is an edge of the shape: every
/// neighbour is in the same plane, within float precision (twice rounding_m()). Wherever two shapes touch or
/// are closest, an edge or a corner of one of them takes part. Queries can therefore skip pairs of triangles
/// that are both within flat faces.
class TriangleTree {
 public:
  /// Splits by the surface area heuristic: for meshes that persist. O(n log n). Determines whether the mesh
  /// is closed, and which triangles are within flat faces.
  void build_by_place(const Mesh& mesh);
  /// Groups runs of consecutive triangles: for meshes of a single frame (rows of a depth image are already
  /// spatially ordered). O(n); allocates nothing once as many were stored. is_closed() is false, and no
  /// triangle counts as within a flat face.
  void build_in_order(const Mesh& mesh);

  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t dropped_triangles() const { return dropped_triangles_; }
  /// Origin in the mesh's frame, m: a local point plus the origin is a point in the mesh's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// All of the mesh's vertices, local, in the mesh's order.
  [[nodiscard]] std::span<const Eigen::Vector3f> vertices() const { return vertices_; }
  /// In the tree's order, which differs from the mesh's after build_by_place().
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  /// Unique per build of any tree, 0 before the first build: a cache key.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Returns true if the mesh is closed and counter-clockwise seen from outside, so points can be inside it.
  /// Every edge is used equally often in both directions (vertices at the same position are one), and every
  /// connected component has a positive volume.
  [[nodiscard]] bool is_closed() const { return is_closed_; }

  /// The root is the first node; empty without triangles.
  [[nodiscard]] std::span<const TreeNode> nodes() const { return nodes_; }
  /// Local point at the centre of all triangles' box; the origin of the nodes' boxes.
  [[nodiscard]] const Eigen::Vector3d& centre() const { return centre_; }
  /// Half the size of the box around all triangles, about centre().
  [[nodiscard]] const Eigen::Vector3f& half_size() const { return half_size_; }
  /// Max error of a float box around its triangles' corners, m. The boxes already include it.
  [[nodiscard]] float rounding_m() const { return rounding_m_; }

 private:
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  std::vector<Eigen::Vector3f> vertices_;
  std::vector<Triangle> triangles_;
  std::vector<TreeNode> nodes_;
  std::size_t dropped_triangles_ = 0;
  std::uint64_t revision_ = 0;
  bool is_closed_ = false;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  Eigen::Vector3f half_size_ = Eigen::Vector3f::Zero();
  float rounding_m_ = 0.0F;

  void take(const Mesh& mesh);
};

}  // namespace roomradar
