// gpu_mesh.hpp: a triangle mesh in OpenGL buffers, with a CPU copy for exact queries; draws it, also with
// positions only.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "radar/geometry/box_tree.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/mesh_chunks.hpp"

namespace roomradar {

enum class MeshUsage {
  /// Uploaded once, drawn often. Triangles are reordered spatially.
  kStatic,
  /// Replaced every frame. Buffers are reused, the order of triangles is kept, and invalid triangles are
  /// dropped.
  kStreamed,
};

/// Owns vertex and index buffers. Vertices are relative to the mesh's origin, which is stored in double.
/// Callers compose matrices in double, so a mesh a thousand kilometres from the world's origin keeps its
/// precision. Not thread safe.
class GpuMesh {
 public:
  explicit GpuMesh(GlContext& context);
  ~GpuMesh();
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  /// Replaces the mesh, its normals and its colours. An empty mesh is valid and draws nothing.
  ///
  /// A triangle is invalid if an index is past the last vertex or one of its vertices is not finite. kStatic
  /// rejects a mesh with an invalid triangle, and keeps the previous mesh. kStreamed drops and counts invalid
  /// triangles. kStreamed allocates nothing once a mesh of this size has been uploaded.
  /// @throws Error if the mesh is rejected (kStatic), its origin is not finite, or it has more than 2^31 / 3
  ///         triangles. Throws if the number of normals or colours is neither 0 nor the number of vertices.
  ///         Throws if the renderer is lost or has no memory; the mesh is then empty.
  void upload(const Mesh& mesh, MeshUsage usage);

  /// Replaces the mesh; the tree's triangles and vertices serve as the CPU copy.
  /// @param tree  built from this mesh (by build_in_order() for kStreamed); Error is thrown if the numbers of
  ///              vertices or triangles differ. Must not be destroyed or rebuilt before the next upload
  void upload(const Mesh& mesh, MeshUsage usage, const TriangleTree& tree);
  /// Adds texture coordinates, one per vertex, to a mesh uploaded as kStatic: vertex attribute 3 (vec2).
  /// Throws Error if their number differs from the number of vertices, or if the renderer has no memory.
  void upload_texture_points(std::span<const Eigen::Vector2f> points);
  /// Returns the tree of the last upload, or null if it had none.
  [[nodiscard]] const TriangleTree* tree() const { return tree_; }

  /// Draws the chunks that may be inside the clip volume (-w..w, -w..w, 0..w) with the current program. The
  /// current GL state decides on face culling. Vertex attribute 0 is the position (vec3, local). Attribute 1
  /// is the normal (vec3, local), or 0 0 1 if the mesh has none. Attribute 2 is the colour (vec3, 0 to 1), or
  /// 0.8 grey if the mesh has none.
  ///
  /// @param clip_from_local  maps local points (relative to origin()) to clip space, see clip_from_local()
  /// @return number of triangles passed to the renderer
  std::size_t draw(const Eigen::Matrix4d& clip_from_local) const;

  /// Calls work(first_triangle, triangle_count) for each contiguous range of triangles() in chunks whose
  /// bounding boxes satisfy `reaches(box)`. Boxes are Eigen::AlignedBox3d in local coordinates. If `reaches`
  /// is true for a box, it must also be true for every box that contains that box.
  template <typename Reaches, typename Work>
  void visit_runs(const Reaches& reaches, const Work& work) const {
    std::uint32_t first = 0;
    // Adjacent chunks are merged into one range.
    std::uint32_t count = 0;
    chunk_tree_.visit(reaches, [&](std::size_t i) {
      const MeshChunk& chunk = chunked_.chunks[i];
      if (count > 0 && chunk.first_triangle != first + count) {
        work(first, count);
        count = 0;
      }
      if (count == 0) first = chunk.first_triangle;
      count += chunk.triangle_count;
    });
    if (count > 0) work(first, count);
  }

  /// Returns a number that is unique per upload of any mesh in the process.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// Returns the GL buffer of positions, 3 floats per vertex.
  [[nodiscard]] unsigned position_buffer() const { return buffers_[0]; }
  /// Returns the GL buffer of indices, 3 uint32 per triangle.
  [[nodiscard]] unsigned index_buffer() const { return buffers_[3]; }

  [[nodiscard]] std::size_t triangle_count() const { return triangles().size(); }
  [[nodiscard]] std::size_t dropped_triangles() const { return chunked_.dropped_triangles; }
  [[nodiscard]] bool has_normals() const { return has_normals_; }
  [[nodiscard]] bool has_colours() const { return has_colours_; }

  /// Returns the origin in the mesh's frame, m. A local point plus the origin is a point in the mesh's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// Returns the bounding box in the mesh's frame (origin() added), m. Empty if there are no triangles.
  [[nodiscard]] Eigen::AlignedBox3d bounds() const;

  /// Returns the chunks of the CPU copy, in local coordinates.
  [[nodiscard]] std::span<const MeshChunk> chunks() const { return chunked_.chunks; }
  /// Returns the CPU copy's triangles in drawing order, which for kStatic differs from the uploaded order.
  [[nodiscard]] std::span<const Triangle> triangles() const {
    return tree_ != nullptr ? tree_->triangles() : chunked_.triangles;
  }
  /// Returns the CPU copy's vertices, local (relative to origin()), m.
  [[nodiscard]] std::span<const Eigen::Vector3f> vertices() const {
    return tree_ != nullptr ? tree_->vertices() : vertices_;
  }

 private:
  unsigned vertex_array_ = 0;
  // GL buffers: positions, normals, colours, indices.
  std::array<unsigned, 4> buffers_{};
  unsigned texture_points_ = 0;  // GL buffer; 0: none
  std::array<std::size_t, 4> capacity_bytes_{};
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  // Tree that holds the CPU copy; if null, vertices_ and chunked_ hold it.
  const TriangleTree* tree_ = nullptr;
  std::vector<Eigen::Vector3f> vertices_;
  ChunkedTriangles chunked_;
  BoxTree chunk_tree_;
  // Bounding boxes of the chunks, from which chunk_tree_ is built.
  std::vector<Eigen::AlignedBox3d> chunk_boxes_;
  std::uint64_t revision_ = 0;
  bool has_normals_ = false;
  bool has_colours_ = false;

  void send(const Mesh& mesh, MeshUsage usage);
  void fill_buffer(std::size_t which, const void* data, std::size_t size_bytes, MeshUsage usage);
};

/// A mesh with a pose in the world. Does not own the mesh, which must outlive the instance.
struct MeshInstance {
  const GpuMesh* mesh = nullptr;
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
};

/// Returns the matrix from the instance's local points (relative to its mesh's origin) to clip space.
/// Composed in double.
Eigen::Matrix4d clip_from_local(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world);

/// Vertex shader of programs used with draw_positions(). Attribute 0 is the local position; uniform 0 is the
/// matrix from local to clip space.
inline constexpr const char* kPositionShader = R"(#version 450 core
layout(location = 0) in vec3 p_local;
layout(location = 0) uniform mat4 clip_from_local;
void main() { gl_Position = clip_from_local * vec4(p_local, 1.0); }
)";

/// Draws the instance with the current program. Its mesh must not be null.
/// @return number of triangles passed to the renderer
std::size_t draw_positions(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world);

}  // namespace roomradar
