// room_blocks.hpp: a room's mesh in blocks of space, with version counters, so that a client fetches only
// what has changed.
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

/// The triangles whose centroid is in one cube of the world.
struct RoomBlock {
  std::uint64_t version = 0;  ///< >= 1; increases when the triangles change
  std::uint64_t hash = 0;     ///< of the triangles, in any order
  std::size_t vertices = 0;
  Eigen::AlignedBox3d box_world;
  std::vector<Triangle> triangles{};  ///< vertices of the whole mesh; empty: all are gone
};

/// Blocks by id. An id states the cube's place and never changes.
using RoomBlocks = std::map<std::uint64_t, RoomBlock>;

/// Sorts a mesh's triangles into blocks. The versions of blocks that differ from `before` grow by 1, and
/// blocks of `before` without triangles stay, empty.
RoomBlocks room_blocks(const Mesh& mesh, const RoomBlocks& before = {});

/// Writes the description of each block to the caller's buffer.
void write_blocks(const RoomBlocks& blocks, roomradar_block* to, std::size_t capacity, std::size_t* needed);
/// Writes one block's mesh to the caller's buffers. Throws Refusal for an id without a block.
/// @param mesh  the whole mesh, to which the blocks belong
void write_block_mesh(const Mesh& mesh, const RoomBlocks& blocks, std::uint64_t id,
                      roomradar_mesh_buffers* to);

}  // namespace roomradar::c_api
