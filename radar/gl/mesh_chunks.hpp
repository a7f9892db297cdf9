// mesh_chunks.hpp: divides a mesh's triangles into contiguous ranges (chunks) with bounding boxes, so passes
// can skip invisible ones.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A contiguous range of triangles.
struct MeshChunk {
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  /// Bounding box of the triangles, relative to the mesh's origin, m.
  Eigen::AlignedBox3f bounds_local;
};

struct ChunkedTriangles {
  std::vector<Triangle> triangles;
  std::vector<MeshChunk> chunks;
  /// Bounding box of all triangles, relative to the mesh's origin, m; empty if there are none.
  Eigen::AlignedBox3f bounds_local;
  /// Number of triangles skipped because a vertex is not finite or an index is past the last vertex.
  std::size_t dropped_triangles = 0;
};

/// Sorts the triangles by the Morton codes of their centres, and cuts the list into chunks of `max_triangles`
/// nearby triangles. For meshes that are drawn in many frames. O(n log n).
void chunk_by_place(const Mesh& mesh, std::uint32_t max_triangles, ChunkedTriangles& out);

/// Cuts the triangles into chunks of `max_triangles`, in their given order. For meshes of a single depth
/// image, whose rows are already spatially ordered. O(n). Allocates nothing once `out` has held this many
/// triangles.
void chunk_in_order(const Mesh& mesh, std::uint32_t max_triangles, ChunkedTriangles& out);

/// Sets out.chunks and out.bounds_local for triangles stored elsewhere. All triangles must be valid.
void cut_into_chunks(std::span<const Eigen::Vector3f> vertices, std::span<const Triangle> triangles,
                     std::uint32_t max_triangles, ChunkedTriangles& out);

}  // namespace roomradar
