// surface_parts.cpp: halves the map's nodes until the parts are small; merges the parts' common vertices.
#include "mapping/surface/surface_parts.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>

#include "mapping/surface/tsdf_bricks.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr int kNode_voxels = 4;

/// Returns the nodes that have a sample, each by its lowest voxel divided by 4. Of the eight nodes that share
/// a brick of coarse cells, returns the lowest.
std::vector<VoxelIndex> nodes_with_samples(const StaticMap& map) {
  static_assert(kBrickEdge == kNode_voxels);
  std::vector<VoxelIndex> nodes;
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(map.reach_m());
  map.visit_cells({-reach_m, reach_m}, [&](const SurfaceSample& sample, int edge) {
    const VoxelIndex node =
        edge * sample.voxel.unaryExpr([&](int v) { return floor_div(v, edge * kNode_voxels); });
    if (nodes.empty() || nodes.back() != node) nodes.push_back(node);  // a brick's cells follow each other
  });
  return nodes;
}

/// Appends the boxes of some nodes, all within `box`.
void divide(std::span<VoxelIndex> nodes, std::size_t most_bricks, double node_m,
            const Eigen::AlignedBox3d& box, std::vector<Eigen::AlignedBox3d>& boxes) {
  VoxelIndex low = VoxelIndex::Zero(), high = VoxelIndex::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    low = i == 0 ? nodes[i] : VoxelIndex(low.cwiseMin(nodes[i]));
    high = i == 0 ? nodes[i] : VoxelIndex(high.cwiseMax(nodes[i]));
  }
  if (nodes.size() <= most_bricks || low == high) {
    boxes.push_back(box);
    return;
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const auto middle = nodes.begin() + static_cast<std::ptrdiff_t>(nodes.size() / 2);
  std::nth_element(nodes.begin(), middle, nodes.end(),
                   [axis](const VoxelIndex& a, const VoxelIndex& b) { return a[axis] < b[axis]; });
  const int plane = std::max((*middle)[axis], low[axis] + 1);  // neither side is empty
  const auto first_above =
      std::partition(nodes.begin(), nodes.end(), [&](const VoxelIndex& node) { return node[axis] < plane; });
  Eigen::AlignedBox3d below = box, above = box;
  below.max()[axis] = above.min()[axis] = plane * node_m;
  divide({nodes.begin(), first_above}, most_bricks, node_m, below, boxes);
  divide({first_above, nodes.end()}, most_bricks, node_m, above, boxes);
}

/// Returns whether a triangle's centre is in the box. Vertices are on a grid of 2^-17 m, so their sum is
/// exact.
bool owns(const Eigen::AlignedBox3d& box, const Mesh& mesh, const Triangle& t) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : t) sum += mesh.origin + mesh.vertices[v].cast<double>();
  const Eigen::Array3d centre = sum.array() / 3.0;
  return (centre >= box.min().array()).all() && (centre < box.max().array()).all();
}

/// The parts joined so far.
class JoinedParts {
 public:
  void add(const Mesh& part, const Eigen::AlignedBox3d& box) {
    if (part.vertices.empty()) return;
    if (joined_.vertices.empty()) joined_.origin = part.origin;
    enum : std::uint8_t { kOwn = 1, kOthers = 2 };
    std::vector<std::uint8_t> users(part.vertices.size(), 0);
    std::vector<bool> is_own(part.triangles.size());
    for (std::size_t t = 0; t < part.triangles.size(); ++t) {
      is_own[t] = owns(box, part, part.triangles[t]);
      for (const std::uint32_t v : part.triangles[t]) users[v] |= is_own[t] ? kOwn : kOthers;
    }
    std::vector<std::uint32_t> index(part.vertices.size(), 0);  // in joined_
    for (std::uint32_t v = 0; v < part.vertices.size(); ++v) {
      if ((users[v] & kOwn) == 0) continue;
      const Eigen::Vector3f position =
          (part.vertices[v].cast<double>() + (part.origin - joined_.origin)).cast<float>();
      index[v] = static_cast<std::uint32_t>(joined_.vertices.size());
      if ((users[v] & kOthers) != 0) {
        const auto [found, is_new] =
            on_seam_.try_emplace({position.x(), position.y(), position.z()}, index[v]);
        index[v] = found->second;
        if (!is_new) continue;
      }
      joined_.vertices.push_back(position);
      joined_.normals.push_back(part.normals[v]);
      joined_.colours.push_back(part.colours[v]);
    }
    for (std::size_t t = 0; t < part.triangles.size(); ++t)
      if (const Triangle& corners = part.triangles[t]; is_own[t])
        joined_.triangles.push_back({index[corners[0]], index[corners[1]], index[corners[2]]});
  }
  Mesh take() { return std::move(joined_); }

 private:
  Mesh joined_;
  std::map<std::array<float, 3>, std::uint32_t> on_seam_;  // vertices by their position
};

}  // namespace

std::vector<Eigen::AlignedBox3d> divide(const StaticMap& map, std::size_t most_bricks) {
  std::vector<VoxelIndex> nodes = nodes_with_samples(map);
  std::vector<Eigen::AlignedBox3d> boxes;
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(map.reach_m());
  divide(nodes, most_bricks, kNode_voxels * map.resolution_m(), {-reach_m, reach_m}, boxes);
  return boxes;
}

Mesh join_parts(const std::vector<Eigen::AlignedBox3d>& boxes,
                const std::function<Mesh(const Eigen::AlignedBox3d&)>& extract) {
  if (boxes.size() == 1) return extract(boxes.front());
  JoinedParts joined;
  for (const Eigen::AlignedBox3d& box : boxes) joined.add(extract(box), box);
  return joined.take();
}

}  // namespace roomradar
