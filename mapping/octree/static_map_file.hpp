// static_map_file.hpp: reads and writes the octree as OctoMap files (.ot and .bt). Private to StaticMap.
#pragma once
#include <filesystem>
#include <functional>

#include "mapping/octree/block_octree.hpp"

namespace roomradar {

/// Writes a .ot file; see StaticMap::write_ot().
void write_ot_file(const BlockOctree& tree, const std::filesystem::path& path);
/// Writes a .bt file; see StaticMap::write_bt().
void write_bt_file(const BlockOctree& tree, const std::filesystem::path& path);

/// Callback that makes an empty octree of the given resolution and returns a reference to it. The octree must
/// outlive the call of read_ot_file().
using MakeOctree = std::function<BlockOctree&(double resolution_m)>;
/// Reads a .ot file; see StaticMap::read_ot(). Calls `make_tree` once the file's header is read, and fills
/// the tree that it returns.
void read_ot_file(const std::filesystem::path& path, const MakeOctree& make_tree);

}  // namespace roomradar
