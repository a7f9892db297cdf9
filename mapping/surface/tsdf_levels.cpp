// tsdf_levels.cpp: sorts cells into two grids, and mirrors each grid's samples in the other.
#include "mapping/surface/tsdf_levels.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <unordered_set>
#include <utility>
#include <vector>

#include "mapping/types/system/parallel_for.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr int kNodeEdge = 4;  // voxels; the cells of a node have one size
constexpr int kCoarsePerNode = kNodeEdge / kCoarseEdge;

VoxelIndex divided(const VoxelIndex& cell, int by) {
  return cell.unaryExpr([by](int v) { return floor_div(v, by); });
}

/// Set of integer cells that remembers the order in which they were added.
class CellSet {
 public:
  void add(const VoxelIndex& cell) {
    if (!cells.empty() && cells.back() == cell) return;
    if (keys_.insert(voxel_key(cell)).second) cells.push_back(cell);
  }
  [[nodiscard]] bool has(const VoxelIndex& cell) const { return keys_.contains(voxel_key(cell)); }

  std::vector<VoxelIndex> cells;

 private:
  std::unordered_set<std::uint64_t> keys_;
};

template <typename Visit>
void for_each_in_cube(int edge, const Visit& visit) {
  for (int z = 0; z < edge; ++z)
    for (int y = 0; y < edge; ++y)
      for (int x = 0; x < edge; ++x) visit(Eigen::Vector3i(x, y, z));
}

/// Returns for each place of a cell in its brick the neighbouring bricks that the cell touches, one bit each,
/// numbered as by neighbour_offset().
std::array<std::uint32_t, kBrickSize> touched_bricks() {
  std::array<std::uint32_t, kBrickSize> touched{};
  const auto side = [](int at) { return at == 0 ? -1 : at == kBrickEdge - 1 ? 1 : 0; };
  for_each_in_cube(kBrickEdge, [&](const Eigen::Vector3i& at) {
    const Eigen::Vector3i sides = at.unaryExpr(side);
    for (int i = 0; i < kCellsRound; ++i)
      if (i != kOwnCell && neighbour_offset(i).cwiseProduct(sides) == neighbour_offset(i).cwiseAbs())
        touched[brick_offset(at)] |= 1U << static_cast<unsigned>(i);
  });
  return touched;
}

/// Bricks of a grid: those with a sample, and those that a sample near the surface touches. Samples are
/// extrapolated there.
class BrickSet {
 public:
  /// Adds the brick of a cell. Cells of one brick should follow each other.
  /// @param distance_cells  signed distance, in edges of a cell
  void add(const VoxelIndex& cell, float distance_cells) {
    // Of two samples with a zero crossing between them, one is nearer than this.
    constexpr float kNear_cells = 1.5F;
    static const std::array<std::uint32_t, kBrickSize> kTouched = touched_bricks();
    const VoxelIndex first = brick_of(cell);
    if (first != first_) {
      add_touched();
      first_ = first;
      bricks_.add(first);
    }
    if (std::abs(distance_cells) <= kNear_cells) touched_ |= kTouched[brick_offset(cell - first)];
  }
  void add_brick(const VoxelIndex& first) { bricks_.add(first); }
  /// Returns the lowest cells of the bricks.
  [[nodiscard]] const std::vector<VoxelIndex>& firsts() {
    add_touched();
    return bricks_.cells;
  }

 private:
  CellSet bricks_;
  VoxelIndex first_ = VoxelIndex::Ones();  // lowest cell of the brick added last; of none at the start
  std::uint32_t touched_ = 0;              // its neighbours to be added

  void add_touched() {
    for (int i = 0; touched_ != 0; ++i, touched_ >>= 1U)
      if ((touched_ & 1U) != 0) bricks_.add(first_ + kBrickEdge * neighbour_offset(i));
  }
};

/// Calls visit(node) for the 26 nodes around each node of a set.
template <typename Visit>
void for_each_beside(const CellSet& nodes, const Visit& visit) {
  for (const VoxelIndex& node : nodes.cells)
    for (int i = 0; i < kCellsRound; ++i)
      if (i != kOwnCell) visit(VoxelIndex(node + neighbour_offset(i)));
}

/// Finds samples of a grid, faster if successive ones are in the same brick.
template <typename Bricks>
class SampleFinder {
 public:
  explicit SampleFinder(Bricks& bricks) : bricks_(bricks) {}
  /// Returns the sample of a cell; null if no brick has it.
  auto* operator()(const VoxelIndex& cell) {
    const VoxelIndex first = brick_of(cell);
    if (!(first == first_)) {
      first_ = first;
      brick_ = bricks_.find(first);
    }
    return brick_ == TsdfBricks::kNone ? nullptr
                                       : &bricks_.bricks()[brick_].samples[brick_offset(cell - first)];
  }

 private:
  Bricks& bricks_;
  VoxelIndex first_ = VoxelIndex::Ones();  // lowest voxel of the brick found last; of none at the start
  std::size_t brick_ = TsdfBricks::kNone;
};

/// Calls work(begin, end) for ranges of nodes, on all cores.
template <typename Work>
void for_ranges_of(const std::vector<VoxelIndex>& nodes, const Work& work) {
  constexpr std::size_t kNodesAtOnce = 256;
  parallel_ranges(nodes.size(), kNodesAtOnce, work);
}

TsdfSample mirrored(TsdfSample sample, float distance_m) {
  sample.distance_m = distance_m;
  sample.mirrored = true;
  return sample;
}

TsdfSample unknown_mirrored() { return mirrored({}, 0.0F); }

}  // namespace

const TsdfSample* sample_in(const TsdfBricks& bricks, const VoxelIndex& cell) {
  return SampleFinder(bricks)(cell);
}

TsdfLevels::TsdfLevels(const StaticMap& map, float min_weight, const Eigen::AlignedBox3d& box_world)
    : voxels(std::vector<VoxelIndex>{}), coarse(std::vector<VoxelIndex>{}) {
  // The nodes and bricks of each grid.
  CellSet voxel_nodes, coarse_nodes;
  BrickSet voxel_bricks, coarse_bricks;
  const auto voxel_m = static_cast<float>(map.resolution_m());
  map.visit_cells(box_world, [&](const SurfaceSample& sample, int edge) {
    if (sample.weight < min_weight) return;
    (edge == 1 ? voxel_nodes : coarse_nodes).add(divided(sample.voxel, kNodeEdge));
    if (edge == 1)
      voxel_bricks.add(sample.voxel, sample.distance_m / voxel_m);
    else
      coarse_bricks.add(divided(sample.voxel, kCoarseEdge), sample.distance_m / (kCoarseEdge * voxel_m));
  });
  CellSet around_voxels, coarse_beside, voxels_beside;
  for_each_beside(voxel_nodes, [&](const VoxelIndex& node) {
    if (!voxel_nodes.has(node) && !coarse_nodes.has(node)) around_voxels.add(node);
  });
  const auto is_of_voxels = [&](const VoxelIndex& node) {
    return voxel_nodes.has(node) || around_voxels.has(node);
  };
  for_each_beside(coarse_nodes, [&](const VoxelIndex& node) {
    if (is_of_voxels(node)) voxels_beside.add(node);
  });
  for_each_beside(voxels_beside, [&](const VoxelIndex& node) {
    if (!is_of_voxels(node)) coarse_beside.add(node);
  });

  // The bricks, with the places that belong to the other grid marked.
  for (const VoxelIndex& node : coarse_beside.cells) voxel_bricks.add_brick(brick_of(kNodeEdge * node));
  for (const VoxelIndex& node : voxels_beside.cells) coarse_bricks.add_brick(brick_of(kCoarsePerNode * node));
  voxels = TsdfBricks(voxel_bricks.firsts());
  coarse = TsdfBricks(coarse_bricks.firsts());
  const auto mark = [&](TsdfBricks& bricks, int node_edge, bool marks_voxels) {
    for (Brick& brick : bricks.bricks())
      for_each_in_cube(kBrickEdge / node_edge, [&](const Eigen::Vector3i& at) {
        if (is_of_voxels(divided(brick.first, node_edge) + at) != marks_voxels) return;
        for_each_in_cube(node_edge, [&](const Eigen::Vector3i& cell) {
          brick.samples[brick_offset(node_edge * at + cell)].mirrored = true;
        });
      });
  };
  mark(voxels, kNodeEdge, false);
  mark(coarse, kCoarsePerNode, true);
  coarse_beside_voxels_ = std::move(coarse_beside.cells);
  voxels_beside_coarse_ = std::move(voxels_beside.cells);

  // The samples.
  SampleFinder in_voxels(voxels), in_coarse(coarse);
  map.visit_cells(box_world, [&](const SurfaceSample& sample, int edge) {
    if (sample.weight < min_weight) return;
    const VoxelIndex cell = edge == 1 ? sample.voxel : divided(sample.voxel, kCoarseEdge);
    *(edge == 1 ? in_voxels : in_coarse)(cell) = {.distance_m = sample.distance_m,
                                                  .weight = sample.weight,
                                                  .colour = sample.colour,
                                                  .has_colour = sample.has_colour};
  });
  mirror_voxels_in_coarse();
  mirror_coarse_in_voxels();
}

void TsdfLevels::mirror_coarse_in_voxels() {
  for_ranges_of(coarse_beside_voxels_, [&](std::size_t begin, std::size_t end) {
    SampleFinder in_coarse(std::as_const(coarse)), beside(std::as_const(coarse));
    SampleFinder in_voxels(voxels);
    for (std::size_t i = begin; i < end; ++i)
      for_each_in_cube(kCoarsePerNode, [&](const Eigen::Vector3i& at) {
        const VoxelIndex cell = kCoarsePerNode * coarse_beside_voxels_[i] + at;
        const TsdfSample* own = in_coarse(cell);
        const bool is_known = own != nullptr && own->known();
        std::array<std::array<float, 2>, 3> step_m{};  // [axis][side]: change to the voxels on that side
        for (int axis = 0; is_known && axis < 3; ++axis) {
          std::array<bool, 2> has{};
          auto& steps = step_m[static_cast<std::size_t>(axis)];
          for (std::size_t side = 0; side < 2; ++side) {
            const VoxelIndex next_cell = cell + (side == 0 ? -1 : 1) * VoxelIndex::Unit(axis);
            const bool is_in_brick = brick_of(next_cell) == brick_of(cell);
            const TsdfSample* next = (is_in_brick ? in_coarse : beside)(next_cell);
            has[side] = next != nullptr && next->known();
            if (has[side]) steps[side] = 0.25F * (next->distance_m - own->distance_m);
          }
          for (std::size_t side = 0; side < 2; ++side)
            if (!has[side]) steps[side] = -steps[1 - side];
        }
        for_each_in_cube(kCoarseEdge, [&](const Eigen::Vector3i& offset) {
          TsdfSample& voxel = *in_voxels(kCoarseEdge * cell + offset);
          voxel = unknown_mirrored();
          if (!is_known) return;
          float distance_m = own->distance_m;
          for (std::size_t axis = 0; axis < 3; ++axis)
            distance_m += step_m[axis][static_cast<std::size_t>(offset[static_cast<Eigen::Index>(axis)])];
          voxel = mirrored(*own, distance_m);
        });
      });
  });
}

void TsdfLevels::mirror_voxels_in_coarse() {
  for_ranges_of(voxels_beside_coarse_, [&](std::size_t begin, std::size_t end) {
    SampleFinder in_voxels(std::as_const(voxels));
    SampleFinder in_coarse(coarse);
    for (std::size_t i = begin; i < end; ++i)
      for_each_in_cube(kCoarsePerNode, [&](const Eigen::Vector3i& at) {
        const VoxelIndex cell = kCoarsePerNode * voxels_beside_coarse_[i] + at;
        float sum_m = 0.0F;
        int known = 0;
        TsdfSample any;
        for_each_in_cube(kCoarseEdge, [&](const Eigen::Vector3i& offset) {
          const TsdfSample* voxel = in_voxels(kCoarseEdge * cell + offset);
          if (voxel == nullptr || !voxel->known()) return;
          sum_m += voxel->distance_m;
          any = *voxel;
          ++known;
        });
        constexpr int kVoxelsPerCell = kCoarseEdge * kCoarseEdge * kCoarseEdge;
        *in_coarse(cell) =
            known == kVoxelsPerCell ? mirrored(any, sum_m / kVoxelsPerCell) : unknown_mirrored();
      });
  });
}

}  // namespace roomradar
