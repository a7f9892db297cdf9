// static_map_file.hpp: reads and writes the octree in OctoMap's file formats. Private to StaticMap.
#pragma once
#include <filesystem>
#include <functional>

#include "mapping/octree/block_octree.hpp"

namespace roomradar {

/// See StaticMap::write_ot().
void write_ot_file(const BlockOctree& tree, const std::filesystem::path& path);
/// See StaticMap::write_bt().
void write_bt_file(const BlockOctree& tree, const std::filesystem::path& path);

/// Returns an empty octree of this resolution, which outlives the call.
using MakeOctree = std::function<BlockOctree&(double resolution_m)>;
/// See StaticMap::read_ot(). Fills the tree from `make_tree`, called once the header is read.
void read_ot_file(const std::filesystem::path& path, const MakeOctree& make_tree);

}  // namespace roomradar
