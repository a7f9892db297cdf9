// triangle_tree.hpp: triangle mesh on the CPU with an 8-wide bounding volume hierarchy (BVH), for exact
// queries.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Node with eight child boxes, stored as a structure of arrays for SIMD. Boxes are relative to
/// TriangleTree::centre(). Each contains all triangles below it in the tree, with a margin for rounding.
/// Unused entries repeat the first box.
struct alignas(32) TreeNode {
  static constexpr int kWidth = 8;
  std::array<float, kWidth> centre_x, centre_y, centre_z;  // centres of the boxes, m
  std::array<float, kWidth> half_x, half_y, half_z;        // half sizes of the boxes, m
  std::array<std::uint32_t, kWidth> first;  // leaf: index of its first triangle; inner child: index in
                                            // nodes()
  std::array<std::uint32_t, kWidth> count;  // leaf: number of triangles; inner child: 0
  std::uint32_t child_count = 0;
  std::uint32_t within_faces = 0;  // bit i: all triangles below box i are within flat faces
};

/// A rigid mesh (a virtual object, a saved room) or a mesh of a single frame. Vertices are float, relative to
/// the mesh's own double-precision origin, so precision does not degrade far from zero. Triangles with an
/// index past the last vertex, or with a vertex that is not finite, are dropped and counted. Degenerate and
/// duplicate triangles are kept. Uses no OpenGL. Concurrent reading is thread safe; building is not.
///
/// A triangle of a closed mesh is within a flat face if all its neighbours are in the same plane, within
/// float precision (twice rounding_m()). None of its edges is then an edge of the solid. Where two solids
/// touch or are closest, an edge or a vertex of one of the solids is involved. Queries can therefore skip
/// pairs of triangles that are both within flat faces.
class TriangleTree {
 public:
  /// Builds the tree with the surface area heuristic, for meshes that persist. O(n log n). Determines whether
  /// the mesh is closed, and which triangles are within flat faces.
  void build_by_place(const Mesh& mesh);
  /// Builds the tree over ranges of consecutive triangles. For meshes of a single frame, since rows of a
  /// depth image are already spatially ordered. O(n). Allocates nothing if an earlier mesh was at least as
  /// large. is_closed() is then false, and no triangle counts as within a flat face.
  void build_in_order(const Mesh& mesh);

  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t dropped_triangles() const { return dropped_triangles_; }
  /// Returns the origin of the local points, in the mesh's frame, m: mesh point = local point + origin().
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// Returns all vertices of the mesh as local points, m, in the mesh's order.
  [[nodiscard]] std::span<const Eigen::Vector3f> vertices() const { return vertices_; }
  /// Returns the triangles in the tree's order, which differs from the mesh's order after build_by_place().
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  /// Returns a number that is unique per build, across all trees, for use as a cache key; 0 before the first
  /// build.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Returns true if the mesh is closed and its triangles are counter-clockwise seen from outside. In a
  /// closed mesh, triangles use every edge equally often in both directions. Vertices at the same position
  /// count as one. Every connected component has a positive volume.
  [[nodiscard]] bool is_closed() const { return is_closed_; }

  /// Returns the nodes of the tree, root first; empty if there are no triangles.
  [[nodiscard]] std::span<const TreeNode> nodes() const { return nodes_; }
  /// Returns the centre of the box around all triangles, as a local point, m. The nodes' boxes are relative
  /// to it.
  [[nodiscard]] const Eigen::Vector3d& centre() const { return centre_; }
  /// Returns half the size of the box around all triangles, m.
  [[nodiscard]] const Eigen::Vector3f& half_size() const { return half_size_; }
  /// Returns the max rounding error of a node's float box, m. The boxes are already enlarged by this error.
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
