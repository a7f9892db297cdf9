// static_map_octree.hpp: data members of StaticMap. Private to StaticMap's source files.
#pragma once
#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/fusion.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

struct StaticMap::Octree {
  Octree(double resolution_m, const FusionConfig& fusion);
  FusionConfig config;
  BlockOctree tree;
  FusionScratch scratch;
};

}  // namespace roomradar
