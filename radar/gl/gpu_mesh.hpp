// gpu_mesh.hpp: a triangle mesh in the renderer's memory, with a copy at hand for exact questions.
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
  kStatic,    ///< uploaded once, drawn often: triangles are reordered by place
  kStreamed,  ///< new every frame: buffers are reused, order is kept, unusable triangles are dropped
};

/// Owns vertex and index buffers. Vertices stay relative to the mesh's own double-precision origin; whoever
/// draws composes matrices in double first, so that a room a thousand kilometres from zero loses nothing. Not
/// thread safe.
class GpuMesh {
 public:
  explicit GpuMesh(GlContext& context);
  ~GpuMesh();
  GpuMesh(const GpuMesh&) = delete;
  GpuMesh& operator=(const GpuMesh&) = delete;

  /// Replaces the mesh. Normals and colours go along where the mesh has one a vertex.
  ///
  /// kStatic refuses a mesh with any vertex in use that is not finite, or any index past the last vertex, and
  /// keeps what was there. kStreamed drops such triangles and counts them; it allocates nothing once a mesh
  /// as large was here. An empty mesh is fine and draws nothing.
  /// @throws Error if refused (kStatic), or if normals or colours are there but not one a vertex, or the
  ///         origin is not finite, or there are more than 2^31 / 3 triangles; or if the renderer has no room
  ///         for it or is gone: then it is empty
  void upload(const Mesh& mesh, MeshUsage usage);

  /// The same with triangles and the copy at hand shared with a tree instead of held twice.
  /// @param tree  built from this mesh (in order for kStreamed); stays and is not built anew until the next
  ///              upload
  void upload(const Mesh& mesh, MeshUsage usage, const TriangleTree& tree);
  /// What the last upload shares, or null.
  [[nodiscard]] const TriangleTree* tree() const { return tree_; }

  /// Draws with the program in use those chunks that may be inside the clip volume (-w..w, -w..w, 0..w), both
  /// sides of a triangle or one as the GL state says. Attributes: 0 position (vec3, local), 1 normal (vec3,
  /// local; absent: 0 0 1), 2 colour (vec3, 0 to 1; absent: 0.8 grey).
  ///
  /// @param clip_from_local  maps local points (relative to origin()) to clip space: clip_from_local() below
  /// @return number of triangles handed to the renderer
  std::size_t draw(const Eigen::Matrix4d& clip_from_local) const;

  /// Calls work(first_triangle, triangle_count) for each run of triangles() whose boxes `reaches(box)` says
  /// yes to; boxes are AlignedBox3d, local. Whatever holds for a box must hold for every box around it.
  template <typename Reaches, typename Work>
  void visit_runs(const Reaches& reaches, const Work& work) const {
    std::uint32_t first = 0;
    std::uint32_t count = 0;  // neighbouring chunks are one run
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

  /// Different after every upload to any mesh of the process.
  [[nodiscard]] std::uint64_t revision() const { return revision_; }
  /// GL buffers: positions as 3 float, indices as 3 uint32 a triangle.
  [[nodiscard]] unsigned position_buffer() const { return buffers_[0]; }
  [[nodiscard]] unsigned index_buffer() const { return buffers_[3]; }

  [[nodiscard]] std::size_t triangle_count() const { return triangles().size(); }
  [[nodiscard]] std::size_t dropped_triangles() const { return chunked_.dropped_triangles; }
  [[nodiscard]] bool has_normals() const { return has_normals_; }
  [[nodiscard]] bool has_colours() const { return has_colours_; }

  /// m, in the mesh's frame; a local point plus this is a point in the mesh's frame.
  [[nodiscard]] const Eigen::Vector3d& origin() const { return origin_; }
  /// In the mesh's frame (origin included); empty (isEmpty()) where there is no triangle.
  [[nodiscard]] Eigen::AlignedBox3d bounds() const;

  /// The copy at hand, all local. Triangles are in the order drawn, which is not the uploaded one for
  /// kStatic.
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
  const TriangleTree* tree_ = nullptr;  // shared; else the copy is in the next two
  std::vector<Eigen::Vector3f> vertices_;
  ChunkedTriangles chunked_;
  BoxTree chunk_tree_;
  std::vector<Eigen::AlignedBox3d> chunk_boxes_;  // to build the tree from
  std::uint64_t revision_ = 0;
  bool has_normals_ = false;
  bool has_colours_ = false;

  void send(const Mesh& mesh, MeshUsage usage);
  void fill_buffer(std::size_t which, const void* data, std::size_t size_bytes, MeshUsage usage);
};

/// A mesh somewhere in the world. The mesh is not owned and must stay while this is used.
struct MeshInstance {
  const GpuMesh* mesh = nullptr;
  Eigen::Isometry3d T_world_mesh = Eigen::Isometry3d::Identity();
};

/// Clip space from the instance's local points (relative to its mesh's origin), composed in double.
Eigen::Matrix4d clip_from_local(const MeshInstance& instance, const Eigen::Matrix4d& clip_from_world);

}  // namespace roomradar
