// gpu_mesh.hpp: a triangle mesh in the renderer's memory, with a CPU copy for exact queries.
#pragma once
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
  kStatic,    ///< uploaded once, drawn often; triangles are reordered spatially
  kStreamed,  ///< new every frame; buffers are reused, order is kept, unusable triangles are dropped
};

/// Owns vertex and index buffers. Vertices are relative to the mesh's own double-precision origin. Callers
/// that draw compose matrices in double first, so a room a thousand kilometres from zero keeps its precision.
/// Not thread safe.
class GpuMesh {
 public:
  explicit GpuMesh(GlContext& context);
  ~GpuMesh();
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  /// Replaces the mesh, with its normals and colours if it has one per vertex.
  ///
  /// kStatic rejects a mesh with a used vertex that is not finite or an index past the last vertex, and keeps
  /// the previous mesh. kStreamed drops such triangles and counts them; it allocates nothing once a mesh as
  /// large was uploaded. An empty mesh is valid and draws nothing.
  /// @throws Error if rejected (kStatic), if there are normals or colours but not one per vertex, if the
  ///         origin is not finite, or if there are more than 2^31 / 3 triangles. Also if the renderer has no
  ///         memory or is lost; the mesh is then empty.
  void upload(const Mesh& mesh, MeshUsage usage);

  /// Uploads a mesh and shares triangles and CPU copy with a tree instead of storing them twice.
  /// @param tree  built from this mesh (in order for kStreamed); must not be destroyed or rebuilt before the
  ///              next upload
  void upload(const Mesh& mesh, MeshUsage usage, const TriangleTree& tree);
  /// Tree of the last upload, or null.
  [[nodiscard]] const TriangleTree* tree() const { return tree_; }

  /// Draws the chunks that may be inside the clip volume (-w..w, -w..w, 0..w) with the current program. GL
  /// state decides on face culling. Attributes: 0 position (vec3, local), 1 normal (vec3, local; 0 0 1 if
  /// absent), 2 colour (vec3, 0 to 1; 0.8 grey if absent).
  ///
  /// @param clip_from_local  maps local points (relative to origin()) to clip space, see clip_from_local()
  /// @return number of triangles passed to the renderer
  std::size_t draw(const Eigen::Matrix4d& clip_from_local) const;

  /// Calls work(first_triangle, triangle_count) for each run of triangles() for whose boxes `reaches(box)` is
  /// true; boxes are AlignedBox3d, local. If `reaches` is true for a box, it must be true for every box
  /// around it.
  template <typename Reaches, typename Work>
  void visit_runs(const Reaches& reaches, const Work& work) const {
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // adjacent chunks form one run
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

  /// Unique per upload of any mesh in the process.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// GL buffers: positions as 3 float per vertex, indices as 3 uint32 per triangle.
  [[nodiscard]] unsigned position_buffer() const { return buffers_[0]; }
  [[nodiscard]] unsigned index_buffer() const { return buffers_[3]; }

  [[nodiscard]] std::size_t triangle_count() const { return triangles().size(); }
  [[nodiscard]] std::size_t dropped_triangles() const { return chunked_.dropped_triangles; }
  [[nodiscard]] bool has_normals() const { return has_normals_; }
  [[nodiscard]] bool has_colours() const { return has_colours_; }

  /// Origin in the mesh's frame, m: a local point plus the origin is a point in the mesh's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// Bounds in the mesh's frame (origin included), m; isEmpty() without triangles.
  [[nodiscard]] Eigen::AlignedBox3d bounds() const;

  /// CPU copy, all local. Triangles are in drawing order, which for kStatic differs from the uploaded order.
  [[nodiscard]] std::span<const MeshChunk> chunks() const { return chunked_.chunks; }
  [[nodiscard]] std::span<const Triangle> triangles() const {
    return tree_ != nullptr ? tree_->triangles() : chunked_.triangles;
  }
  [[nodiscard]] std::span<const Eigen::Vector3f> vertices() const {
    return tree_ != nullptr ? tree_->vertices() : vertices_;
  }

 private:
  unsigned vertex_array_ = 0;
  std::array<unsigned, 4> buffers_{};  // positions, normals, colours, indices
  std::array<std::size_t, 4> capacity_bytes_{};
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  const TriangleTree* tree_ = nullptr;  // if null, the copy is in the next two members
  std::vector<Eigen::Vector3f> vertices_;
  ChunkedTriangles chunked_;
  BoxTree chunk_tree_;
  std::vector<Eigen::AlignedBox3d> chunk_boxes_;  // input of chunk_tree_
  std::uint64_t revision_ = 0;
  bool has_normals_ = false;
  bool has_colours_ = false;

  void send(const Mesh& mesh, MeshUsage usage);
  void fill_buffer(std::size_t which, const void* data, std::size_t size_bytes, MeshUsage usage);
};

/// A mesh with a pose in the world. Does not own the mesh, which must outlive it.
struct MeshInstance {
  const GpuMesh* mesh = nullptr;
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
};

/// Returns the matrix from the instance's local points (relative to its mesh's origin) to clip space,
/// composed in double.
Eigen::Matrix4d clip_from_local(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world);

}  // namespace roomradar
