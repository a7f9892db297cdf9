// triangle_tree.hpp: a mesh at hand for exact questions: triangles under an 8-wide tree of boxes.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Eight boxes side by side, as loops over all eight want them. Boxes are relative to TriangleTree::centre()
/// and hold what is under them with all rounding counted in. Unused places repeat the first box.
struct alignas(32) TreeNode {
  static constexpr int kWidth = 8;
  std::array<float, kWidth> centre_x, centre_y, centre_z;  // m
  std::array<float, kWidth> half_x, half_y, half_z;        // m
  std::array<std::uint32_t, kWidth>
      first;  // of a leaf: its first triangle; else the child's place in nodes()
  std::array<std::uint32_t, kWidth> count;  // of a leaf: its triangles; 0: an inner child
  std::uint32_t child_count = 0;
  std::uint32_t within_faces = 0;  // bit i: all triangles under box i lie within flat faces
};

/// A rigid mesh (a sensor object, a saved room) or one that lives a frame, on the processor's side. Vertices
/// stay float, relative to the mesh's own double origin, so that nothing is lost far from zero. Triangles
/// with an index past the last vertex or a vertex that is not finite are left out and counted; degenerate and
/// duplicate ones stay. No GL. Reading is thread safe, building is not.
///
/// A triangle of a closed mesh lies within a flat face where no edge of its own is one of the shape's: beyond
/// each lies another triangle of the same plane, as far as floats can say (twice rounding_m()). Where two
/// shapes meet, or are nearest, an edge or a corner of one of them takes part: two triangles that both lie
/// within flat faces have nothing to say to each other.
class TriangleTree {
 public:
  /// Splits by place where the boxes get smallest: for meshes that stay. O(n log n). Finds out whether the
  /// mesh is closed, and what of it lies within flat faces.
  void build_by_place(const Mesh& mesh);
  /// Runs of consecutive triangles: for meshes that live one frame (rows of a depth image already lie near
  /// each other). O(n), no allocation once as many were held. is_closed() is not looked at and false, as is
  /// what lies within flat faces.
  void build_in_order(const Mesh& mesh);

  [[nodiscard]] bool empty() const { return triangles_.empty(); }
  [[nodiscard]] std::size_t triangle_count() const { return triangles_.size(); }
  [[nodiscard]] std::size_t dropped_triangles() const { return dropped_triangles_; }
  /// m, in the mesh's frame: a local point plus this is a point in the mesh's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// All of the mesh's vertices, local, in the mesh's order.
  [[nodiscard]] std::span<const Eigen::Vector3f> vertices() const { return vertices_; }
  /// In the tree's order, which is not the mesh's after build_by_place().
  [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
  /// Changes with every build of any tree, never 0 once built: keys caches.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Every edge has as many triangles on one side as on the other (vertices at the same place are one) and
  /// the volume inside each part that hangs together is positive: counter-clockwise seen from outside, so
  /// that a point can be inside.
  [[nodiscard]] bool is_closed() const { return is_closed_; }

  /// The root is the first node; empty without triangles.
  [[nodiscard]] std::span<const TreeNode> nodes() const { return nodes_; }
  /// Local point at the middle of all triangles: what the nodes' boxes are relative to.
  [[nodiscard]] const Eigen::Vector3d& centre() const { return centre_; }
  /// Half the size of the box around all triangles, about centre().
  [[nodiscard]] const Eigen::Vector3f& half_size() const { return half_size_; }
  /// How far a box may be from what its triangles' corners say: rounding of float boxes, m. Already counted
  /// into the boxes.
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
