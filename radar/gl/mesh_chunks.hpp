// mesh_chunks.hpp: triangles in runs with bounding boxes, so passes can skip invisible runs.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A run of consecutive triangles.
struct MeshChunk {
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
  Eigen::AlignedBox3f bounds_local;  ///< m, relative to the mesh's origin
};

struct ChunkedTriangles {
  std::vector<Triangle> triangles;
  std::vector<MeshChunk> chunks;
  Eigen::AlignedBox3f bounds_local;   ///< of all triangles; empty if there are none
  std::size_t dropped_triangles = 0;  ///< skipped: a vertex not finite or an index past the last vertex
};

/// Groups nearby triangles: Morton order of their centres, then runs of `max_triangles`. For meshes that
/// persist. O(n log n).
void chunk_by_place(const Mesh& mesh, std::uint32_t max_triangles, ChunkedTriangles& out);

/// Cuts the triangles into runs of `max_triangles` in their given order. For meshes of a single frame: the
/// rows of a depth image are already spatially ordered. O(n); allocates nothing once `out` has had as many.
void chunk_in_order(const Mesh& mesh, std::uint32_t max_triangles, ChunkedTriangles& out);

/// Sets out.chunks and out.bounds_local for triangles stored elsewhere; all must be usable.
void cut_into_chunks(std::span<const Eigen::Vector3f> vertices, std::span<const Triangle> triangles,
                     std::uint32_t max_triangles, ChunkedTriangles& out);

}  // namespace roomradar
