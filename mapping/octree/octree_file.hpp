// octree_file.hpp: reads and writes the octree as compressed blocks (octree.bin). Private to StaticMap.
#pragma once
#include <filesystem>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/static_map_file.hpp"

namespace roomradar {

/// Writes the tree's blocks; see StaticMap::write().
void write_octree_file(const BlockOctree& tree, const std::filesystem::path& path);
/// Reads a file written by write_octree_file(); see StaticMap::read(). Calls `make_tree` once the resolution
/// is known, and fills the tree that it returns.
void read_octree_file(const std::filesystem::path& path, const MakeOctree& make_tree);

}  // namespace roomradar
