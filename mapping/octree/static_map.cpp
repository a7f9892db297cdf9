// static_map.cpp: fusion into the octree, and queries on it.
#include "mapping/octree/static_map.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mapping/octree/fusion.hpp"
#include "mapping/octree/map_samples.hpp"
#include "mapping/octree/octree_file.hpp"
#include "mapping/octree/prepared_frame.hpp"
#include "mapping/octree/static_map_file.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"
#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

const FusionConfig& checked(const FusionConfig& config) {
  require_valid(config);
  return config;
}

double checked_resolution(double resolution_m) {
  if (!(resolution_m >= 0.001 && resolution_m <= 1.0))
    throw Error("resolution = " + format_number(resolution_m) + " m: must be between 0.001 and 1 m");
  return resolution_m;
}

/// Returns the number of threads to fuse a frame with. Small images are not worth several.
unsigned threads_for(const DepthImage& depth_m, const FusionConfig& config) {
  constexpr std::size_t kWorthAThread_px = 25'000;
  const std::size_t most = config.threads > 0 ? static_cast<std::size_t>(config.threads) : hardware_threads();
  return static_cast<unsigned>(
      std::clamp<std::size_t>(std::min(most, depth_m.pixels.size() / kWorthAThread_px), 1, kMaxLanes));
}

}  // namespace

struct StaticMap::Octree {
  Octree(double resolution_m, const FusionConfig& fusion);
  FusionConfig config;
  BlockOctree tree;
  PreparedFrame prepared;  ///< reused by fuse() of a frame that is not prepared
};

StaticMap::Octree::Octree(double resolution_m, const FusionConfig& fusion)
    : config(checked(fusion)), tree(checked_resolution(resolution_m), config) {}

StaticMap::StaticMap(double resolution_m, const FusionConfig& config)
    : octree_(std::make_unique<Octree>(resolution_m, config)) {}
StaticMap::StaticMap(std::unique_ptr<Octree> octree) : octree_(std::move(octree)) {}
StaticMap::~StaticMap() = default;
StaticMap::StaticMap(StaticMap&&) noexcept = default;
StaticMap& StaticMap::operator=(StaticMap&&) noexcept = default;

FuseStatus StaticMap::fuse(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  prepare_frame(frame, T_world_camera, resolution_m(), config(), threads_for(frame.depth_m, config()),
                octree_->prepared);
  return fuse(frame, octree_->prepared);
}

void StaticMap::prepare(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                        PreparedFrame& prepared) const {
  prepare_frame(frame, T_world_camera, resolution_m(), config(), /*threads=*/1, prepared);
}

FuseStatus StaticMap::fuse(const Frame& frame, const PreparedFrame& prepared) {
  if (prepared.status == FuseStatus::kFused)
    fuse_depth(octree_->tree, frame, prepared.T_world_camera, prepared.config, prepared.scratch,
               {.threads = threads_for(frame.depth_m, config())});
  return prepared.status;
}

Occupancy StaticMap::occupancy_at(const Eigen::Vector3d& p_world) const {
  return roomradar::occupancy_at(octree_->tree, p_world);
}
std::optional<SurfaceSample> StaticMap::sample_at(const Eigen::Vector3d& p_world) const {
  return roomradar::sample_at(octree_->tree, p_world);
}
void StaticMap::visit_samples(const std::function<void(const SurfaceSample&)>& visit) const {
  roomradar::visit_samples(octree_->tree, {}, visit);
}
void StaticMap::visit_samples(const Eigen::AlignedBox3d& box_world,
                              const std::function<void(const SurfaceSample&)>& visit) const {
  roomradar::visit_samples(octree_->tree, keys_in(box_world, resolution_m()), visit);
}

void StaticMap::visit_cells(const Eigen::AlignedBox3d& box_world,
                            const std::function<void(const SurfaceSample&, int)>& visit) const {
  roomradar::visit_cells(octree_->tree, keys_in(box_world, resolution_m()), visit);
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

void StaticMap::add_evidence(const StaticMap& other) {
  roomradar::add_evidence(octree_->tree, octree_->config, other.octree_->tree);
}

void StaticMap::add_evidence(const StaticMap& other, const VoxelIndex& lowest_voxel, int edge_voxels) {
  const Eigen::Array3i first = lowest_voxel.array() + kKeyOrigin;
  roomradar::add_evidence(octree_->tree, octree_->config, other.octree_->tree,
                          {first, first + (edge_voxels - 1)});
}

void StaticMap::revise_samples(const std::function<SampleAction(const SurfaceSample&)>& decide) {
  roomradar::revise_samples(octree_->tree, octree_->config, {}, decide);
}
void StaticMap::revise_samples(const Eigen::AlignedBox3d& box_world,
                               const std::function<SampleAction(const SurfaceSample&)>& decide) {
  roomradar::revise_samples(octree_->tree, octree_->config, keys_in(box_world, resolution_m()), decide);
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

void StaticMap::write(const std::filesystem::path& path) const { write_octree_file(octree_->tree, path); }
void StaticMap::write_ot(const std::filesystem::path& path) const { write_ot_file(octree_->tree, path); }
void StaticMap::write_bt(const std::filesystem::path& path) const { write_bt_file(octree_->tree, path); }

template <typename ReadFile>
StaticMap StaticMap::read_by(const ReadFile& read_file, const FusionConfig& config) {
  std::unique_ptr<Octree> octree;
  read_file([&](double resolution_m) -> BlockOctree& {
    octree = std::make_unique<Octree>(resolution_m, config);
    return octree->tree;
  });
  return StaticMap(std::move(octree));
}

StaticMap StaticMap::read(const std::filesystem::path& path, const FusionConfig& config) {
  return read_by([&](const MakeOctree& make_tree) { read_octree_file(path, make_tree); }, config);
}
StaticMap StaticMap::read_ot(const std::filesystem::path& path, const FusionConfig& config) {
  return read_by([&](const MakeOctree& make_tree) { read_ot_file(path, make_tree); }, config);
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
