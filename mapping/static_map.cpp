// static_map.cpp: fusing into and asking the octree.
#include "mapping/static_map.hpp"

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
void visit_leaves(const RoomOcTree& tree, const RoomNode& node, const Key& key, unsigned depth,
                  const Visit& visit) {
  bool is_leaf = true;
  for (unsigned i = 0; depth < kLeafDepth && i < 8; ++i) {
    const RoomNode* child = tree.child(node, i);
    if (!child) continue;
    is_leaf = false;
    visit_leaves(tree, *child, child_key(key, depth, i), depth + 1, visit);
  }
  if (is_leaf) visit(node, key, depth);
}

template <typename Visit>
void visit_leaves(const RoomOcTree& tree, const Visit& visit) {
  if (const RoomNode* root = tree.getRoot()) visit_leaves(tree, *root, Key::Zero(), 0, visit);
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
  visit_leaves(octree_->tree, [&](const RoomNode& leaf, const Key& key, unsigned) {
    if (leaf.has_sample()) visit(sample_of(leaf, key));
  });
}

void StaticMap::revise_samples(const std::function<SampleFate(const SurfaceSample&)>& decide) {
  RoomOcTree& tree = octree_->tree;
  RoomNode* root = tree.getRoot();
  if (root && !revise(tree, *root, Key::Zero(), 0, octree_->config.min_log_odds, decide)) tree.remove_root();
}

double StaticMap::resolution_m() const { return octree_->tree.getResolution(); }
double StaticMap::reach_m() const { return resolution_m() * kKeyOrigin; }
const FusionConfig& StaticMap::config() const { return octree_->config; }

MapCounts StaticMap::counts() const {
  MapCounts counts;
  const RoomOcTree& tree = octree_->tree;
  visit_leaves(tree, [&](const RoomNode& leaf, const Key& key, unsigned depth) {
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
