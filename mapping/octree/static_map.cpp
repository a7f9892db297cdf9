// static_map.cpp: fusion into the octree, and queries on it.
#include "mapping/octree/static_map.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mapping/octree/map_evidence.hpp"
#include "mapping/octree/static_map_file.hpp"
#include "mapping/octree/static_map_octree.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/validity.hpp"

namespace roomradar {
namespace {

Occupancy occupancy_of(LogOdds log_odds) {
  if (log_odds == 0) return Occupancy::kUnknown;
  return log_odds > 0 ? Occupancy::kOccupied : Occupancy::kFree;
}

SurfaceSample sample_of(const BlockOctree& tree, const LeafBlock& block, unsigned i,
                        const Eigen::Array3i& key) {
  return {.voxel = (key - kKeyOrigin).matrix(),
          .occupancy = occupancy_of(block.log_odds[i]),
          .distance_m = block.distance[i] * tree.units().distance_m,
          .weight = block.weight[i] * tree.units().weight,
          .colour = tree.colour(block, i),
          .has_colour = (block.coloured >> i & 1U) != 0};
}

// Node that contains a voxel: a leaf block and the voxel's index in it, or a node that is not a block.
struct Found {
  Eigen::Array3i key = Eigen::Array3i::Zero();
  Slot node;
  const LeafBlock* block = nullptr;
  unsigned i = 0;

  [[nodiscard]] LogOdds log_odds() const { return block ? block->log_odds[i] : node.log_odds(); }
};

Found find(const BlockOctree& tree, const Eigen::Vector3d& p_world) {
  const Eigen::Array3d voxel = (p_world / tree.resolution_m()).array().floor() + kKeyOrigin;
  if (!(voxel >= 0.0).all() || !(voxel <= 65535.0).all()) return {};
  Found found{.key = voxel.cast<int>(), .node = tree.root};
  NodePlace place;
  for (; found.node.is_block() && place.depth < kLeafDepth - 1; ++place.depth)
    found.node = tree.inner(found.node).slots[place.towards(found.key)];
  if (!found.node.is_block()) return found;
  found.block = &tree.leaves(found.node);
  found.i = place.towards(found.key);
  return found;
}

// Calls `decide` on every sample of the subtree that is in the range. Returns the node's new state.
Slot revise(BlockOctree& tree, Slot node, const NodePlace& place, LogOdds free, const KeyRange& range,
            const std::function<SampleAction(const SurfaceSample&)>& decide) {
  if (!node.is_block() || !range.meets(place)) return node;
  if (place.depth == kLeafDepth - 1)
    return change_leaves(tree, node, [&](LeafBlock& block) {
      for (unsigned i = 0; i < 8; ++i) {
        const bool is_surface = block.weight[i] != 0 || block.log_odds[i] > 0;
        if (!is_surface || !range.holds(place.child(i).key)) continue;
        const SampleAction fate = decide(sample_of(tree, block, i, place.child(i).key));
        if (fate == SampleAction::kKeep) continue;
        erase_sample(block, i);
        if (fate == SampleAction::kFree) block.log_odds[i] = free;
        if (fate == SampleAction::kUnknown) block.log_odds[i] = 0;
      }
    });
  InnerBlock& block = tree.inner(node);
  for (unsigned i = 0; i < 8; ++i)
    block.slots[i] = revise(tree, block.slots[i], place.child(i), free, range, decide);
  return tree.prune(node, block);
}

// Visits the samples of the subtree that are in the range.
void visit_in(const BlockOctree& tree, Slot node, const NodePlace& place, const KeyRange& range,
              const std::function<void(const SurfaceSample&)>& visit) {
  if (!node.is_block() || !range.meets(place)) return;
  if (place.depth == kLeafDepth - 1) {
    const LeafBlock& block = tree.leaves(node);
    for (unsigned i = 0; i < 8; ++i)
      if (block.weight[i] != 0 && range.holds(place.child(i).key))
        visit(sample_of(tree, block, i, place.child(i).key));
    return;
  }
  const InnerBlock& block = tree.inner(node);
  for (unsigned i = 0; i < 8; ++i) visit_in(tree, block.slots[i], place.child(i), range, visit);
}

const FusionConfig& checked(const FusionConfig& config) {
  require_valid(config);
  return config;
}

double checked_resolution(double resolution_m) {
  if (!(resolution_m >= 0.001 && resolution_m <= 1.0))
    throw Error("resolution = " + format_number(resolution_m) + " m: must be within 0.001 and 1 m");
  return resolution_m;
}

}  // namespace

StaticMap::Octree::Octree(double resolution_m, const FusionConfig& fusion)
    : config(checked(fusion)), tree(checked_resolution(resolution_m), config) {}

StaticMap::StaticMap(double resolution_m, const FusionConfig& config)
    : octree_(std::make_unique<Octree>(resolution_m, config)) {}
StaticMap::StaticMap(std::unique_ptr<Octree> octree) : octree_(std::move(octree)) {}
StaticMap::~StaticMap() = default;
StaticMap::StaticMap(StaticMap&&) noexcept = default;
StaticMap& StaticMap::operator=(StaticMap&&) noexcept = default;

FuseStatus StaticMap::fuse(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  constexpr int kMaxSide_px = 4096;  // pixel indices are computed in float
  if (!depth_fault_of(frame).empty() || std::max(frame.depth_m.width, frame.depth_m.height) > kMaxSide_px)
    return FuseStatus::kInvalidFrame;
  if (!is_rigid(T_world_camera, 1e-3)) return FuseStatus::kInvalidPose;
  Octree& o = *octree_;
  switch (collect_hits(frame, T_world_camera, resolution_m(), o.config, o.scratch)) {
    case HitStatus::kNone:
      return FuseStatus::kNothingMeasured;
    case HitStatus::kOutOfBounds:
      return FuseStatus::kOutOfBounds;
    case HitStatus::kCollected:
      break;
  }
  fuse_depth(o.tree, frame, T_world_camera, o.config, o.scratch);
  return FuseStatus::kFused;
}

Occupancy StaticMap::occupancy_at(const Eigen::Vector3d& p_world) const {
  return occupancy_of(find(octree_->tree, p_world).log_odds());
}

std::optional<SurfaceSample> StaticMap::sample_at(const Eigen::Vector3d& p_world) const {
  const Found found = find(octree_->tree, p_world);
  if (!found.block || found.block->weight[found.i] == 0) return std::nullopt;
  return sample_of(octree_->tree, *found.block, found.i, found.key);
}

void StaticMap::visit_samples(const std::function<void(const SurfaceSample&)>& visit) const {
  const BlockOctree& tree = octree_->tree;
  for_each_part(
      tree, tree.root, {}, [](const NodePlace&, LogOdds) {},
      [&](const NodePlace& place, const LeafBlock& block) {
        for (unsigned i = 0; i < 8; ++i)
          if (block.weight[i] != 0) visit(sample_of(tree, block, i, place.child(i).key));
      });
}

void StaticMap::visit_samples(const Eigen::AlignedBox3d& box_world,
                              const std::function<void(const SurfaceSample&)>& visit) const {
  const BlockOctree& tree = octree_->tree;
  visit_in(tree, tree.root, {}, keys_in(box_world, resolution_m()), visit);
}

void StaticMap::visit_leaves(const std::function<void(const MapLeaf&)>& visit) const {
  const BlockOctree& tree = octree_->tree;
  for_each_leaf(tree, [&](const NodePlace& place, LogOdds log_odds) {
    visit({(place.key - kKeyOrigin).matrix(), place.edge_voxels(), log_odds * tree.units().log_odds});
  });
}

void StaticMap::add_evidence(const MapLeaf& leaf) {
  roomradar::add_evidence(octree_->tree, octree_->config, leaf);
}
void StaticMap::add_evidence(const SurfaceSample& sample) { roomradar::add_evidence(octree_->tree, sample); }

void StaticMap::revise_samples(const std::function<SampleAction(const SurfaceSample&)>& decide) {
  const double reach = reach_m();
  const Eigen::AlignedBox3d all(Eigen::Vector3d::Constant(-reach), Eigen::Vector3d::Constant(reach));
  revise_samples(all, decide);
}

void StaticMap::revise_samples(const Eigen::AlignedBox3d& box_world,
                               const std::function<SampleAction(const SurfaceSample&)>& decide) {
  BlockOctree& tree = octree_->tree;
  const long free = std::lround(octree_->config.min_log_odds / tree.units().log_odds);
  tree.root =
      revise(tree, tree.root, {}, static_cast<LogOdds>(free), keys_in(box_world, resolution_m()), decide);
}

double StaticMap::resolution_m() const { return octree_->tree.resolution_m(); }
double StaticMap::reach_m() const { return resolution_m() * kKeyOrigin; }
const FusionConfig& StaticMap::config() const { return octree_->config; }
std::size_t StaticMap::memory_bytes() const { return octree_->tree.memory_bytes(); }

MapCounts StaticMap::counts() const {
  MapCounts counts;
  const BlockOctree& tree = octree_->tree;
  for_each_leaf(tree, [&](const NodePlace& place, LogOdds log_odds) {
    const Eigen::Vector3d low = (place.key - kKeyOrigin).cast<double>().matrix() * tree.resolution_m();
    const Eigen::Vector3d edges = Eigen::Vector3d::Constant(place.edge_voxels() * tree.resolution_m());
    const Eigen::AlignedBox3d box(low, low + edges);
    counts.known_world.extend(box);
    if (log_odds < 0) {
      ++counts.free_leaves;
    } else {
      ++counts.occupied_leaves;
      counts.occupied_world.extend(box);
    }
  });
  visit_samples([&](const SurfaceSample&) { ++counts.sampled_leaves; });
  const SubtreeSize size = size_of(tree, tree.root, 0);
  counts.nodes = size.nodes;
  counts.memory_bytes = size.bytes;
  return counts;
}

void StaticMap::write_ot(const std::filesystem::path& path) const { write_ot_file(octree_->tree, path); }
void StaticMap::write_bt(const std::filesystem::path& path) const { write_bt_file(octree_->tree, path); }

StaticMap StaticMap::read_ot(const std::filesystem::path& path, const FusionConfig& config) {
  std::unique_ptr<Octree> octree;
  read_ot_file(path, [&](double resolution_m) -> BlockOctree& {
    octree = std::make_unique<Octree>(resolution_m, config);
    return octree->tree;
  });
  return StaticMap(std::move(octree));
}

std::string_view to_string(FuseStatus status) {
  switch (status) {
    case FuseStatus::kFused:
      return "fused";
    case FuseStatus::kNothingMeasured:
      return "nothing measured";
    case FuseStatus::kInvalidFrame:
      return "invalid frame";
    case FuseStatus::kInvalidPose:
      return "invalid pose";
    case FuseStatus::kOutOfBounds:
      return "out of the octree's reach";
  }
  return "unknown status";
}

}  // namespace roomradar
