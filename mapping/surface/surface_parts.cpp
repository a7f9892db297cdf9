// surface_parts.cpp: halves the map's bricks until the parts are small; merges the parts' common vertices.
#include "mapping/surface/surface_parts.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>

#include "mapping/mesh/components.hpp"
#include "mapping/surface/tsdf_bricks.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

/// Returns the bricks that have a sample, each by its lowest voxel divided by kBrickEdge. Bricks of coarse
/// cells are among those of voxels.
std::vector<VoxelIndex> bricks_with_samples(const StaticMap& map) {
  std::vector<VoxelIndex> bricks;
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(map.reach_m());
  map.visit_cells({-reach_m, reach_m}, [&](const SurfaceSample& sample, int edge) {
    const VoxelIndex brick =
        edge * sample.voxel.unaryExpr([&](int v) { return floor_div(v, edge * kBrickEdge); });
    if (bricks.empty() || bricks.back() != brick)
      bricks.push_back(brick);  // a brick's cells follow each other
  });
  return bricks;
}

/// Appends the boxes of some bricks, all within `box`.
void divide(std::span<VoxelIndex> bricks, std::size_t most_bricks, double brick_m,
            const Eigen::AlignedBox3d& box, std::vector<Eigen::AlignedBox3d>& boxes) {
  VoxelIndex low = VoxelIndex::Zero(), high = VoxelIndex::Zero();
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    low = i == 0 ? bricks[i] : VoxelIndex(low.cwiseMin(bricks[i]));
    high = i == 0 ? bricks[i] : VoxelIndex(high.cwiseMax(bricks[i]));
  }
  if (bricks.size() <= most_bricks || low == high) {
    boxes.push_back(box);
    return;
  }
  Eigen::Index axis = 0;
  (high - low).maxCoeff(&axis);
  const auto middle = bricks.begin() + static_cast<std::ptrdiff_t>(bricks.size() / 2);
  std::nth_element(bricks.begin(), middle, bricks.end(),
                   [axis](const VoxelIndex& a, const VoxelIndex& b) { return a[axis] < b[axis]; });
  const int plane = std::max((*middle)[axis], low[axis] + 1);  // neither side is empty
  const auto first_above = std::partition(bricks.begin(), bricks.end(),
                                          [&](const VoxelIndex& brick) { return brick[axis] < plane; });
  Eigen::AlignedBox3d below = box, above = box;
  below.max()[axis] = above.min()[axis] = plane * brick_m;
  divide({bricks.begin(), first_above}, most_bricks, brick_m, below, boxes);
  divide({first_above, bricks.end()}, most_bricks, brick_m, above, boxes);
}

Eigen::Vector3d centre_world(const Mesh& mesh, const Triangle& triangle) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t v : triangle) sum += mesh.origin + mesh.vertices[v].cast<double>();
  return sum / 3.0;
}

/// The parts joined so far.
class JoinedParts {
 public:
  void add(const SurfacePart& part) {
    const Mesh& mesh = part.mesh;
    if (joined_.vertices.empty()) joined_.origin = mesh.origin;
    std::vector<std::uint32_t> index(mesh.vertices.size());  // in joined_
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      const Eigen::Vector3f position =
          (mesh.vertices[v].cast<double>() + (mesh.origin - joined_.origin)).cast<float>();
      index[v] = static_cast<std::uint32_t>(joined_.vertices.size());
      if (part.on_seam[v]) {
        const auto [found, is_new] =
            on_seam_.try_emplace({position.x(), position.y(), position.z()}, index[v]);
        index[v] = found->second;
        if (!is_new) continue;
      }
      joined_.vertices.push_back(position);
      joined_.normals.push_back(mesh.normals[v]);
      joined_.colours.push_back(mesh.colours[v]);
    }
    for (const Triangle& t : mesh.triangles)
      joined_.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
  }
  Mesh take() {
    joined_.vertices.shrink_to_fit();
    joined_.normals.shrink_to_fit();
    joined_.colours.shrink_to_fit();
    joined_.triangles.shrink_to_fit();
    return std::move(joined_);
  }

 private:
  Mesh joined_;
  std::map<std::array<float, 3>, std::uint32_t> on_seam_;  // vertices by their position
};

}  // namespace

SurfacePart part_in(const Eigen::AlignedBox3d& box_world, Mesh mesh) {
  std::vector<bool> is_others(mesh.vertices.size(), false);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Eigen::Array3d centre = centre_world(mesh, t).array();
    if ((centre >= box_world.min().array()).all() && (centre < box_world.max().array()).all()) return false;
    for (const std::uint32_t v : t) is_others[v] = true;
    return true;
  });
  SurfacePart part;
  for (const std::uint32_t v : drop_unused_vertices(mesh)) part.on_seam.push_back(is_others[v]);
  part.mesh = std::move(mesh);
  return part;
}

std::vector<Eigen::AlignedBox3d> divide(const StaticMap& map, std::size_t most_bricks) {
  std::vector<VoxelIndex> bricks = bricks_with_samples(map);
  std::vector<Eigen::AlignedBox3d> boxes;
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(map.reach_m());
  divide(bricks, most_bricks, kBrickEdge * map.resolution_m(), {-reach_m, reach_m}, boxes);
  return boxes;
}

Mesh join_parts(const std::vector<Eigen::AlignedBox3d>& boxes,
                const std::function<SurfacePart(const Eigen::AlignedBox3d&)>& extract) {
  if (boxes.size() == 1) return extract(boxes.front()).mesh;
  JoinedParts joined;
  for (const Eigen::AlignedBox3d& box : boxes) joined.add(extract(box));
  return joined.take();
}

}  // namespace roomradar
