// mesh_blocks.hpp: a mesh cut into blocks of triangles that can be worked on one by one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Reorders the triangles so that each block of at most so many (>= 1) lies together in space: halved at the
/// median of the longest side of their box until they are few enough. The blocks are in mesh.triangles.
std::vector<std::span<Triangle>> sort_into_blocks(Mesh& mesh, std::size_t most_triangles);

/// By vertex: is it a corner of triangles in more than one block?
std::vector<bool> seam_vertices(const Mesh& mesh, const std::vector<std::span<Triangle>>& blocks);

/// A block as a mesh of its own.
struct BlockMesh {
  Mesh mesh;
  std::vector<std::uint32_t> name;  ///< by vertex: its index in the whole mesh, ascending
};
BlockMesh block_mesh(const Mesh& whole, std::span<const Triangle> block);

}  // namespace roomradar
