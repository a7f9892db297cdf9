// room_blocks.cpp: blocks of a room's mesh.
#include "app/c_api/room_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "app/c_api/conversions.hpp"
#include "mapping/mesh/mesh_blocks.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar::c_api {
namespace {

/// Returns the id of the cube that contains a point: 21 bits per axis.
std::uint64_t block_id(const Eigen::Vector3d& p_world) {
  constexpr double kMost = (1 << 20) - 1;  // blocks from the origin, 2,000 km
  std::uint64_t id = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::clamp(std::floor(p_world[axis] / kBlock_m), -kMost, kMost);
    id = (id << 21) | static_cast<std::uint64_t>(static_cast<std::int64_t>(cell) + (1 << 20));
  }
  return id;
}

std::uint64_t mixed(std::uint64_t value) {  // finaliser of SplitMix64
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31);
}

std::uint64_t hash_of(const Mesh& mesh, std::uint32_t vertex) {
  std::uint32_t words[3];
  std::memcpy(words, mesh.vertices[vertex].data(), sizeof words);
  std::uint64_t hash = mixed(words[0] | (std::uint64_t{words[1]} << 32)) + words[2];
  if (!mesh.colours.empty()) {
    const Rgb colour = mesh.colours[vertex];
    hash = mixed(hash) + (colour.r | (colour.g << 8) | (colour.b << 16));
  }
  return mixed(hash);
}

/// Returns a hash that does not depend on which vertex is the first.
std::uint64_t hash_of(const Mesh& mesh, const Triangle& triangle) {
  const std::uint64_t a = hash_of(mesh, triangle[0]), b = hash_of(mesh, triangle[1]),
                      c = hash_of(mesh, triangle[2]);
  return mixed(a * 3 + b) + mixed(b * 3 + c) + mixed(c * 3 + a);
}

Eigen::AlignedBox3d box_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(mesh.origin + vertex.cast<double>());
  return box;
}

}  // namespace

RoomBlocks room_blocks(const Mesh& mesh, const RoomBlocks& before) {
  RoomBlocks blocks;
  for (const auto& [id, block] : before) blocks[id];
  for (const Triangle& triangle : mesh.triangles) {
    if (!is_usable(mesh, triangle)) continue;
    const Eigen::Vector3f sum =
        mesh.vertices[triangle[0]] + mesh.vertices[triangle[1]] + mesh.vertices[triangle[2]];
    RoomBlock& block = blocks[block_id(mesh.origin + sum.cast<double>() / 3.0)];
    block.triangles.push_back(triangle);
    block.hash += hash_of(mesh, triangle);
  }
  for (auto& [id, block] : blocks) {
    const Mesh part = block_mesh(mesh, block.triangles).mesh;
    block.vertices = part.vertices.size();
    block.box_world = box_of(part);
    const auto old = before.find(id);
    if (old == before.end()) {
      block.version = 1;
      continue;
    }
    const bool is_same =
        block.hash == old->second.hash && block.triangles.size() == old->second.triangles.size();
    block.version = old->second.version + (is_same ? 0 : 1);
  }
  return blocks;
}

void write_blocks(const RoomBlocks& blocks, roomradar_block* to, std::size_t capacity, std::size_t* needed) {
  require_capacity(to, capacity, blocks.size(), needed);
  for (const auto& [id, block] : blocks) {
    roomradar_block& one = *to++;
    one.id = id;
    one.version = block.version;
    one.vertex_count = block.vertices;
    one.triangle_count = block.triangles.size();
    const bool is_empty = block.triangles.empty();
    write_vector(is_empty ? Eigen::Vector3d::Zero() : block.box_world.min(), one.min_world_m);
    write_vector(is_empty ? Eigen::Vector3d::Zero() : block.box_world.max(), one.max_world_m);
  }
}

void write_block_mesh(const Mesh& mesh, const RoomBlocks& blocks, std::uint64_t id,
                      roomradar_mesh_buffers* to) {
  const auto found = blocks.find(id);
  if (found == blocks.end()) refuse("block_id = " + std::to_string(id) + ": there is no such block");
  write_mesh(block_mesh(mesh, found->second.triangles).mesh, found->second.version, to);
}

}  // namespace roomradar::c_api
