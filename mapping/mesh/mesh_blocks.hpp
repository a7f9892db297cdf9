// mesh_blocks.hpp: splits a mesh into spatial blocks of triangles that can be processed independently.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Reorders mesh.triangles into spatially compact blocks of at most max_triangles (>= 1) triangles each.
/// Recursively splits at the median of the longest side of the bounding box. The blocks are spans of
/// mesh.triangles.
std::vector<std::span<Triangle>> sort_into_blocks(Mesh& mesh, std::size_t max_triangles);

/// Returns, per vertex, true if triangles of more than one block use the vertex.
std::vector<bool> seam_vertices(const Mesh& mesh, const std::vector<std::span<Triangle>>& blocks);

/// A block as a separate mesh.
struct BlockMesh {
  Mesh mesh;
  std::vector<std::uint32_t> name;  ///< index of each vertex in the whole mesh, ascending
};
BlockMesh block_mesh(const Mesh& whole, std::span<const Triangle> block);

}  // namespace roomradar
