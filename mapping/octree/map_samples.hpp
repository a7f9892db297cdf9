// map_samples.hpp: reads, revises and adds samples per voxel, in fine and coarse cells. Private to StaticMap,
// whose functions of the same names call these.
#pragma once
#include <Eigen/Geometry>
#include <functional>
#include <optional>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/fusion_config.hpp"
#include "mapping/octree/static_map.hpp"

namespace roomradar {

Occupancy occupancy_at(const BlockOctree& tree, const Eigen::Vector3d& p_world);
std::optional<SurfaceSample> sample_at(const BlockOctree& tree, const Eigen::Vector3d& p_world);
void visit_samples(const BlockOctree& tree, const KeyRange& range,
                   const std::function<void(const SurfaceSample&)>& visit);
void visit_cells(const BlockOctree& tree, const KeyRange& range,
                 const std::function<void(const SurfaceSample&, int)>& visit);

/// Refines a coarse cell if `decide` returns an action other than kKeep for one of its voxels.
void revise_samples(BlockOctree& tree, const FusionConfig& config, const KeyRange& range,
                    const std::function<SampleAction(const SurfaceSample&)>& decide);

/// Adds evidence of another map: the log-odds of a leaf, a sample (as a weighted mean), or all in a range of
/// keys.
void add_evidence(BlockOctree& tree, const FusionConfig& config, const MapLeaf& leaf);
void add_evidence(BlockOctree& tree, const SurfaceSample& sample);
void add_evidence(BlockOctree& tree, const FusionConfig& config, const BlockOctree& other,
                  const KeyRange& range = {});

}  // namespace roomradar
