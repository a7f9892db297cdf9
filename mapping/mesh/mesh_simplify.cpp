// mesh_simplify.cpp: per block: collapse, measure, repeat with lower tolerance where the bound is exceeded.
#include "mapping/mesh/mesh_simplify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mapping/mesh/components.hpp"
#include "mapping/mesh/edge_collapse.hpp"
#include "mapping/mesh/mesh_blocks.hpp"
#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/types/system/parallel_for.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

// Vertex tolerance as a fraction of the bound; below 1 because the surface between vertices deviates more in
// places. With a larger fraction, repairs cost more triangles than the collapses save.
constexpr float kOfBound = 0.6F;
constexpr std::uint32_t kNoCorner = ~std::uint32_t{0};  // marks removed triangles
constexpr int kMaxIterations = 10;
constexpr float kTightening = 0.4F;
constexpr float kLeastOfBound = 0.2F;  // below this fraction of the bound a vertex is constrained

// Lowers the tolerance of all vertices within radius_m of a far point.
void tighten_around(const Mesh& mesh, const std::vector<FarPoint>& far, float radius_m, float least_m,
                    std::vector<float>& tolerance_m) {
  const auto cube_of = [&](const Eigen::Vector3f& p) -> Eigen::Vector3i {
    return (p / radius_m).array().floor().cast<int>();
  };
  std::unordered_multimap<std::uint64_t, std::size_t> in_cube;
  for (std::size_t i = 0; i < far.size(); ++i) in_cube.emplace(voxel_key(cube_of(far[i].position)), i);
  const auto is_near = [&](const Eigen::Vector3f& p) {
    for (int n = 0; n < kCellsRound; ++n) {
      const auto [begin, end] = in_cube.equal_range(voxel_key(cube_of(p) + neighbour_offset(n)));
      if (std::any_of(begin, end, [&](const auto& entry) {
            return (far[entry.second].position - p).squaredNorm() <= radius_m * radius_m;
          }))
        return true;
    }
    return false;
  };
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    if (!is_near(mesh.vertices[v])) continue;
    tolerance_m[v] *= kTightening;
    if (tolerance_m[v] < least_m) tolerance_m[v] = 0.0F;
  }
}

// Simplifies one block; vertices keep their indices. Seam vertices stay fixed. A block that exceeds the bound
// in all rounds is returned unchanged.
SimplifiedMesh simplified_block(const Mesh& mesh, std::vector<float> tolerance_m, float max_deviation_m,
                                float spacing_m) {
  const MeshDistanceQuery full_surface(mesh, max_deviation_m);
  float radius_m = spacing_m;
  for (int round = 0; round < kMaxIterations; ++round, radius_m *= 1.5F) {
    SimplifiedMesh result{collapsed(mesh, full_surface, tolerance_m), 0.0F};
    std::vector<FarPoint> far;
    result.deviation_m = greatest_distance_m(result.mesh, full_surface, spacing_m, max_deviation_m, far);
    if (far.empty()) {
      const MeshDistanceQuery simple_surface(result.mesh, max_deviation_m);
      result.deviation_m = std::max(
          result.deviation_m, greatest_distance_m(mesh, simple_surface, spacing_m, max_deviation_m, far));
      if (far.empty()) return result;
    }
    tighten_around(mesh, far, radius_m, kLeastOfBound * max_deviation_m, tolerance_m);
  }
  return {mesh, 0.0F};
}

// Simplifies the blocks of one mesh. Threads may simplify different blocks at a time, since each block writes
// only its own triangles and the vertices that no other block uses.
class BlockSimplifier {
 public:
  BlockSimplifier(Mesh& mesh, float max_deviation_m, float spacing_m, std::size_t block_triangles,
                  std::vector<bool> fixed)
      : mesh_(mesh),
        max_deviation_m_(max_deviation_m),
        spacing_m_(spacing_m),
        blocks_(sort_into_blocks(mesh, block_triangles)),
        fixed_(std::move(fixed)) {
    const std::vector<bool> on_seam = seam_vertices(mesh, blocks_);
    fixed_.resize(mesh.vertices.size(), false);
    for (std::size_t v = 0; v < fixed_.size(); ++v) fixed_[v] = fixed_[v] || on_seam[v];
  }

  [[nodiscard]] std::size_t block_count() const { return blocks_.size(); }

  /// Simplifies a block, and returns its deviation, m.
  float simplify(std::size_t index) {
    const std::span<Triangle> block = blocks_[index];
    const BlockMesh full = block_mesh(mesh_, block);
    std::vector<float> tolerance_m;
    for (const std::uint32_t v : full.name)
      tolerance_m.push_back(fixed_[v] ? 0.0F : kOfBound * max_deviation_m_);
    const SimplifiedMesh result = simplified_block(full.mesh, tolerance_m, max_deviation_m_, spacing_m_);
    const Mesh& simple = result.mesh;
    for (std::size_t v = 0; v < full.name.size(); ++v) {
      const std::uint32_t name = full.name[v];
      if (fixed_[name]) continue;
      mesh_.vertices[name] = simple.vertices[v];
      if (!mesh_.normals.empty()) mesh_.normals[name] = simple.normals[v];
      if (!mesh_.colours.empty()) mesh_.colours[name] = simple.colours[v];
    }
    for (std::size_t t = 0; t < block.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        block[t][k] = t < simple.triangles.size() ? full.name[simple.triangles[t][k]] : kNoCorner;
    return result.deviation_m;
  }

 private:
  Mesh& mesh_;
  float max_deviation_m_;
  float spacing_m_;
  std::vector<std::span<Triangle>> blocks_;
  std::vector<bool> fixed_;  // on the seam of two blocks, or fixed by the caller
};

}  // namespace

SimplifiedMesh simplified(Mesh mesh, float max_deviation_m, float spacing_m, std::size_t block_triangles,
                          std::vector<bool> fixed) {
  BlockSimplifier blocks(mesh, max_deviation_m, spacing_m, block_triangles, std::move(fixed));
  std::vector<float> deviations_m(blocks.block_count());
  parallel_for(blocks.block_count(), hardware_threads(),
               [&](std::size_t block, unsigned) { deviations_m[block] = blocks.simplify(block); });
  float deviation_m = 0.0F;
  for (const float of_block : deviations_m) deviation_m = std::max(deviation_m, of_block);
  std::erase_if(mesh.triangles, [](const Triangle& t) { return t[0] == kNoCorner; });
  std::vector<std::uint32_t> full_vertex = drop_unused_vertices(mesh);
  return {std::move(mesh), deviation_m, std::move(full_vertex)};
}

}  // namespace roomradar
