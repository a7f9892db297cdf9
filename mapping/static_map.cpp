// static_map.cpp: fusing into and asking the octree.
#include "mapping/static_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "mapping/fusion.hpp"
#include "mapping/room_octree.hpp"
#include "mapping/static_map_octree.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

using Key = Eigen::Array3i;

Occupancy occupancy_of(const RoomNode& leaf) {
  if (leaf.getLogOdds() == 0.0F) return Occupancy::kUnknown;
  return leaf.getLogOdds() > 0.0F ? Occupancy::kOccupied : Occupancy::kFree;
}

SurfaceSample sample_of(const RoomNode& leaf, const Key& key) {
  return {.voxel = (key - kKeyOrigin).matrix(),
          .occupancy = occupancy_of(leaf),
          .distance_m = leaf.distance_m,
          .weight = leaf.weight,
          .colour = leaf.colour,
          .has_colour = leaf.colour_count > 0};
}

Key child_key(const Key& key, unsigned depth, unsigned i) {
  const int edge = 1 << (kLeafDepth - depth - 1);
  return key + Key(i & 1U ? edge : 0, i & 2U ? edge : 0, i & 4U ? edge : 0);
}

// Calls visit(node, key of its lowest voxel, depth) for every leaf, in Morton order.
template <typename Visit>
void for_leaves(const RoomOcTree& tree, const RoomNode& node, const Key& key, unsigned depth,
                  const Visit& visit) {
  bool is_leaf = true;
  for (unsigned i = 0; depth < kLeafDepth && i < 8; ++i) {
    const RoomNode* child = tree.child(node, i);
    if (!child) continue;
    is_leaf = false;
    for_leaves(tree, *child, child_key(key, depth, i), depth + 1, visit);
  }
  if (is_leaf) visit(node, key, depth);
}

template <typename Visit>
void for_leaves(const RoomOcTree& tree, const Visit& visit) {
  if (const RoomNode* root = tree.getRoot()) for_leaves(tree, *root, Key::Zero(), 0, visit);
}

// The leaf that holds a point, or null.
const RoomNode* leaf_at(const RoomOcTree& tree, const Eigen::Vector3d& p_world, Key& key) {
  const Eigen::Array3d voxel = (p_world / tree.getResolution()).array().floor() + kKeyOrigin;
  if (!(voxel >= 0.0).all() || !(voxel <= 65535.0).all()) return nullptr;
  key = voxel.cast<int>();
  const RoomNode* node = tree.getRoot();
  for (unsigned depth = 0; node && depth < kLeafDepth && tree.nodeHasChildren(node); ++depth) {
    const unsigned shift = kLeafDepth - 1 - depth;
    const auto digit = [&](int axis) { return static_cast<unsigned>(key[axis] >> shift) & 1U; };
    node = tree.child(*node, digit(0) | digit(1) << 1U | digit(2) << 2U);
  }
  return node;
}

// Decides on every sample below a node. True if the node holds anything afterwards.
bool revise(RoomOcTree& tree, RoomNode& node, const Key& key, unsigned depth, float free_log_odds,
            const std::function<SampleFate(const SurfaceSample&)>& decide) {
  if (depth == kLeafDepth) {
    if (!node.has_sample()) return true;
    const SampleFate fate = decide(sample_of(node, key));
    if (fate == SampleFate::kKeep) return true;
    node.forget_sample();
    if (fate == SampleFate::kFree) node.setLogOdds(free_log_odds);
    return node.getLogOdds() != 0.0F;
  }
  if (!tree.nodeHasChildren(&node)) return true;
  for (unsigned i = 0; i < 8; ++i) {
    RoomNode* child = tree.child(node, i);
    if (child && !revise(tree, *child, child_key(key, depth, i), depth + 1, free_log_odds, decide))
      tree.deleteNodeChild(&node, i);
  }
  if (!tree.nodeHasChildren(&node)) {
    node.free_empty_child_table();
    return false;
  }
  tree.summarise(node);
  return true;
}

// Adds to every leaf at or below a node.
void add_log_odds(RoomOcTree& tree, RoomNode& node, float log_odds, const FusionConfig& config) {
  if (!tree.nodeHasChildren(&node)) {
    node.setLogOdds(std::clamp(node.getLogOdds() + log_odds, config.min_log_odds, config.max_log_odds));
    return;
  }
  for (unsigned i = 0; i < 8; ++i) add_log_odds(tree, tree.ensure_child(node, i), log_odds, config);
  tree.summarise(node);
}

// Changes the node at a key and depth, made where there is none, and sums up those above it.
template <typename Change>
void change_node(RoomOcTree& tree, RoomNode& node, const Key& key, unsigned depth, unsigned target_depth,
                 const Change& change) {
  if (depth == target_depth) return change(node);
  if (node.getLogOdds() != 0.0F && !tree.nodeHasChildren(&node)) tree.expandNode(&node);
  const unsigned shift = kLeafDepth - 1 - depth;
  const auto digit = [&](int axis) { return static_cast<unsigned>(key[axis] >> shift) & 1U; };
  RoomNode& child = tree.ensure_child(node, digit(0) | digit(1) << 1U | digit(2) << 2U);
  change_node(tree, child, key, depth + 1, target_depth, change);
  tree.summarise(node);
}

void require_cube(const VoxelIndex& lowest, int edge_voxels) {
  const Key key = lowest.array() + kKeyOrigin;
  const bool sound = edge_voxels > 0 && edge_voxels <= 1 << kLeafDepth &&
                     std::has_single_bit(static_cast<unsigned>(edge_voxels)) &&
                     (lowest.array() >= -kKeyOrigin).all() && (lowest.array() < kKeyOrigin).all() &&
                     key.unaryExpr([&](int k) { return k & (edge_voxels - 1); }).isZero();
  if (sound) return;
  throw Error(
      "voxel " + std::to_string(lowest.x()) + " " + std::to_string(lowest.y()) + " " +
      std::to_string(lowest.z()) + " with an edge of " + std::to_string(edge_voxels) +
      " is no leaf of an octree: it must lie within +-32768, on a multiple of its edge, a power of two");
}

double checked_resolution(double resolution_m) {
  if (!(resolution_m >= 0.001 && resolution_m <= 1.0))
    throw Error("resolution = " + std::to_string(resolution_m) + " m: must be within 0.001 and 1 m");
  return resolution_m;
}

bool is_usable(const Frame& frame) {
  const Intrinsics& camera = frame.depth_camera;
  return camera.width_px == frame.depth_m.width && camera.height_px == frame.depth_m.height &&
         frame.depth_m.pixels.size() ==
             static_cast<std::size_t>(frame.depth_m.width) * static_cast<std::size_t>(frame.depth_m.height) &&
         !frame.depth_m.empty() && std::isfinite(camera.fx_px) && std::isfinite(camera.fy_px) &&
         camera.fx_px > 0.0 && camera.fy_px > 0.0 && std::isfinite(camera.cx_px) &&
         std::isfinite(camera.cy_px);
}

bool is_rigid(const Eigen::Isometry3d& T) {
  const Eigen::Matrix3d R = T.linear();
  return T.matrix().allFinite() &&
         (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-3 &&
         R.determinant() > 0.0;
}

}  // namespace

StaticMap::Octree::Octree(double resolution_m, const FusionConfig& fusion)
    : config(fusion), tree(checked_resolution(resolution_m)) {
  require_valid(fusion);
}

StaticMap::StaticMap(double resolution_m, const FusionConfig& config)
    : octree_(std::make_unique<Octree>(resolution_m, config)) {}
StaticMap::StaticMap(std::unique_ptr<Octree> octree) : octree_(std::move(octree)) {}
StaticMap::~StaticMap() = default;
StaticMap::StaticMap(StaticMap&&) noexcept = default;
StaticMap& StaticMap::operator=(StaticMap&&) noexcept = default;

FuseStatus StaticMap::fuse(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  if (!is_usable(frame)) return FuseStatus::kInvalidFrame;
  if (!is_rigid(T_world_camera)) return FuseStatus::kInvalidPose;
  Octree& o = *octree_;
  switch (collect_hits(frame, T_world_camera, resolution_m(), o.config, o.scratch)) {
    case HitStatus::kNone:
      return FuseStatus::kNothingMeasured;
    case HitStatus::kOutOfReach:
      return FuseStatus::kOutOfReach;
    case HitStatus::kCollected:
      break;
  }
  fuse_depth(o.tree, frame, T_world_camera, o.config, o.scratch);
  return FuseStatus::kFused;
}

Occupancy StaticMap::occupancy_at(const Eigen::Vector3d& p_world) const {
  Key key;
  const RoomNode* leaf = leaf_at(octree_->tree, p_world, key);
  return leaf ? occupancy_of(*leaf) : Occupancy::kUnknown;
}

std::optional<SurfaceSample> StaticMap::sample_at(const Eigen::Vector3d& p_world) const {
  Key key;
  const RoomNode* leaf = leaf_at(octree_->tree, p_world, key);
  if (!leaf || !leaf->has_sample()) return std::nullopt;
  return sample_of(*leaf, key);
}

void StaticMap::visit_samples(const std::function<void(const SurfaceSample&)>& visit) const {
  for_leaves(octree_->tree, [&](const RoomNode& leaf, const Key& key, unsigned) {
    if (leaf.has_sample()) visit(sample_of(leaf, key));
  });
}

void StaticMap::visit_leaves(const std::function<void(const MapLeaf&)>& visit) const {
  for_leaves(octree_->tree, [&](const RoomNode& leaf, const Key& key, unsigned depth) {
    if (leaf.getLogOdds() != 0.0F)
      visit({(key - kKeyOrigin).matrix(), 1 << (kLeafDepth - depth), leaf.getLogOdds()});
  });
}

void StaticMap::add_evidence(const MapLeaf& leaf) {
  require_cube(leaf.lowest_voxel, leaf.edge_voxels);
  if (!std::isfinite(leaf.log_odds)) throw Error("log-odds of a leaf must be finite");
  if (leaf.log_odds == 0.0F) return;
  RoomOcTree& tree = octree_->tree;
  const auto depth =
      kLeafDepth - static_cast<unsigned>(std::countr_zero(static_cast<unsigned>(leaf.edge_voxels)));
  change_node(tree, tree.ensure_root(), leaf.lowest_voxel.array() + kKeyOrigin, 0, depth,
              [&](RoomNode& node) { add_log_odds(tree, node, leaf.log_odds, octree_->config); });
}

void StaticMap::add_evidence(const SurfaceSample& sample) {
  require_cube(sample.voxel, 1);
  if (!std::isfinite(sample.distance_m) || !(sample.weight > 0.0F) || !std::isfinite(sample.weight))
    throw Error("a sample's distance must be finite, its weight finite and > 0");
  RoomOcTree& tree = octree_->tree;
  change_node(
      tree, tree.ensure_root(), sample.voxel.array() + kKeyOrigin, 0, kLeafDepth, [&](RoomNode& leaf) {
        const float sum = leaf.weight + sample.weight;
        const float part = sample.weight / sum;
        if (sample.has_colour) {
          const float colour_part = leaf.colour_count > 0 ? part : 1.0F;
          const auto blend = [colour_part](std::uint8_t own, std::uint8_t other) {
            const float mean = static_cast<float>(own) + static_cast<float>(other - own) * colour_part;
            return static_cast<std::uint8_t>(std::lround(mean));
          };
          leaf.colour = {blend(leaf.colour.r, sample.colour.r), blend(leaf.colour.g, sample.colour.g),
                         blend(leaf.colour.b, sample.colour.b)};
          leaf.colour_count = std::max<std::uint8_t>(leaf.colour_count, 1);
        }
        leaf.distance_m += (sample.distance_m - leaf.distance_m) * part;
        leaf.weight = std::min(sum, octree_->config.max_weight);
      });
}

void StaticMap::revise_samples(const std::function<SampleFate(const SurfaceSample&)>& decide) {
  RoomOcTree& tree = octree_->tree;
  RoomNode* root = tree.getRoot();
  if (root && !revise(tree, *root, Key::Zero(), 0, octree_->config.min_log_odds, decide)) tree.remove_root();
}

double StaticMap::resolution_m() const { return octree_->tree.getResolution(); }
std::size_t StaticMap::memory_bytes() const {
  return octree_->tree.size() * (sizeof(RoomNode) + sizeof(void*));  // one table of 8 pointers for 8 children
}
double StaticMap::reach_m() const { return resolution_m() * kKeyOrigin; }
const FusionConfig& StaticMap::config() const { return octree_->config; }

MapCounts StaticMap::counts() const {
  MapCounts counts;
  const RoomOcTree& tree = octree_->tree;
  for_leaves(tree, [&](const RoomNode& leaf, const Key& key, unsigned depth) {
    if (leaf.has_sample()) ++counts.sampled_leaves;
    const Occupancy occupancy = occupancy_of(leaf);
    if (occupancy == Occupancy::kUnknown) return;
    const Eigen::Vector3d low = (key - kKeyOrigin).cast<double>().matrix() * tree.getResolution();
    const Eigen::AlignedBox3d box(low, low + Eigen::Vector3d::Constant(tree.getNodeSize(depth)));
    counts.known_world.extend(box);
    if (occupancy == Occupancy::kFree) {
      ++counts.free_leaves;
    } else {
      ++counts.occupied_leaves;
      counts.occupied_world.extend(box);
    }
  });
  counts.nodes = tree.size();
  counts.memory_bytes = tree.memoryUsage();
  return counts;
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
    case FuseStatus::kOutOfReach:
      return "out of the octree's reach";
  }
  return "unknown status";
}

}  // namespace roomradar
