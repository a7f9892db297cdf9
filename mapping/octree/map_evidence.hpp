// map_evidence.hpp: adds the log-odds and samples of another map to the octree. Private to StaticMap.
#pragma once
#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/fusion_config.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

/// Adds a leaf's log-odds, or averages in a sample; see StaticMap::add_evidence().
void add_evidence(BlockOctree& tree, const FusionConfig& config, const MapLeaf& leaf);
void add_evidence(BlockOctree& tree, const SurfaceSample& sample);

}  // namespace roomradar
