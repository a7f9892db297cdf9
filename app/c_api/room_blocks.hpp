// room_blocks.hpp: divides a room's mesh into cubic blocks with version counters, so that a client fetches
// changed blocks only.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "app/c_api/roomradar_types.h"
#include "mapping/types/mesh.hpp"

namespace roomradar::c_api {

/// Edge of a block, m.
inline constexpr double kBlock_m = 2.0;

/// The triangles whose centroid is in one cube of a grid in the world frame.
struct RoomBlock {
  std::uint64_t version = 0;  ///< >= 1; increases when the triangles change
  std::uint64_t hash = 0;     ///< hash of the triangles, independent of their order
  std::size_t vertices = 0;
  Eigen::AlignedBox3d box_world;
  std::vector<Triangle> triangles{};  ///< indices in the whole mesh; empty: none is left
};

/// Blocks by id. An id encodes the cube's position in the grid and never changes.
using RoomBlocks = std::map<std::uint64_t, RoomBlock>;

/// Divides a mesh's triangles into blocks. A new block has version 1. The version of a block that differs
/// from `before` is incremented. Blocks of `before` that have lost all triangles remain in the result,
/// without triangles.
RoomBlocks room_blocks(const Mesh& mesh, const RoomBlocks& before = {});

/// Writes the description of each block to the caller's buffer.
void write_blocks(const RoomBlocks& blocks, roomradar_block* to, std::size_t capacity, std::size_t* needed);
/// Writes one block's mesh to the caller's buffers. Throws Refusal for an id without a block.
/// @param mesh  the mesh from which room_blocks() made the blocks
void write_block_mesh(const Mesh& mesh, const RoomBlocks& blocks, std::uint64_t id,
                      roomradar_mesh_buffers* to);

}  // namespace roomradar::c_api
