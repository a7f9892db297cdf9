// tsdf_smoothing.cpp: red-black Gauss-Seidel sweeps over bricks of samples.
#include "mapping/surface/tsdf_smoothing.hpp"

#include <array>
#include <cstddef>
#include <vector>

#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

// Samples with a weight above this many times the strength are skipped: they would move by less than a tenth
// of the difference to their neighbours.
constexpr float kFirm = 30.0F;
constexpr std::size_t kBricksAtOnce = 64;  // of a thread

// The strength in the grid of coarse cells, relative to that of voxels. Of 1, 1/2, 1/4, 1/8 on a simulated
// dining room, 1/4 and 1/8 kept the shape of edges as well as voxels did; 1/4 has the lower median error.
constexpr float kCoarseStrength = 0.25F;

struct Stencil {
  std::size_t axis;
  int step;  // index step in a brick's arrays
};
constexpr std::array<Stencil, 3> kAxes{{{0, 1}, {1, kBrickEdge}, {2, kBrickEdge* kBrickEdge}}};

struct NeighbourBricks {
  std::array<std::size_t, 3> before{};
  std::array<std::size_t, 3> after{};
};

/// Sweeps over one grid. Keeps the measured distances.
class Sweeps {
 public:
  explicit Sweeps(TsdfBricks& bricks)
      : all_(bricks.bricks()), neighbours_(all_.size()), measured_m_(all_.size()) {
    for (std::size_t b = 0; b < all_.size(); ++b) {
      for (std::size_t a = 0; a < 3; ++a) {
        const VoxelIndex step = kBrickEdge * VoxelIndex::Unit(static_cast<Eigen::Index>(a));
        neighbours_[b].before[a] = bricks.find(all_[b].first - step);
        neighbours_[b].after[a] = bricks.find(all_[b].first + step);
      }
      for (std::size_t i = 0; i < kBrickSize; ++i) measured_m_[b][i] = all_[b].samples[i].distance_m;
    }
  }

  void sweep(float strength) {
    for (const std::size_t parity : {0U, 1U}) half_sweep(strength, parity);
  }

 private:
  std::vector<Brick>& all_;
  std::vector<NeighbourBricks> neighbours_;
  std::vector<std::array<float, kBrickSize>> measured_m_;

  // Smooths the cells whose coordinates have a sum of this parity (0 or 1). Their axis neighbours have the
  // other parity, so the order of cells and bricks does not matter.
  void half_sweep(float strength, std::size_t parity) {
    parallel_ranges(all_.size(), kBricksAtOnce, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) half_sweep_of(b, strength, parity);
    });
  }
  void half_sweep_of(std::size_t b, float strength, std::size_t parity) {
    for (std::size_t i = 0; i < kBrickSize; ++i) {
      if (((i ^ i / kBrickEdge ^ i / (kBrickEdge * kBrickEdge)) & 1U) != parity) continue;
      TsdfSample& sample = all_[b].samples[i];
      if (!sample.known() || sample.mirrored || sample.weight > kFirm * strength) continue;
      float sum = sample.weight * measured_m_[b][i];
      float weight = sample.weight;
      for (const auto& [axis, step] : kAxes) {
        const int coordinate = static_cast<int>(i) / step % kBrickEdge;
        const TsdfSample* before = neighbour(neighbours_[b].before[axis], b, i, -step, coordinate == 0);
        if (!before) continue;
        const TsdfSample* after =
            neighbour(neighbours_[b].after[axis], b, i, step, coordinate == kBrickEdge - 1);
        if (!after) continue;
        sum += strength * 0.5F * (before->distance_m + after->distance_m);
        weight += strength;
      }
      sample.distance_m = sum / weight;
    }
  }

  // The sample one step from i along an axis, in brick b or the next; null if unknown.
  [[nodiscard]] const TsdfSample* neighbour(std::size_t beyond, std::size_t b, std::size_t i, int step,
                                            bool leaves_brick) const {
    const std::size_t brick = leaves_brick ? beyond : b;
    if (brick == TsdfBricks::kNone) return nullptr;
    const auto at = static_cast<int>(i) + (leaves_brick ? -(kBrickEdge - 1) * step : step);
    const TsdfSample& found = all_[brick].samples[static_cast<std::size_t>(at)];
    return found.known() ? &found : nullptr;
  }
};

}  // namespace

void smooth(TsdfLevels& levels, float strength, int sweeps) {
  Sweeps voxels(levels.voxels), coarse(levels.coarse);
  for (int i = 0; i < sweeps; ++i) {
    voxels.sweep(strength);
    levels.mirror_voxels_in_coarse();
    coarse.sweep(kCoarseStrength * strength);
    levels.mirror_coarse_in_voxels();
  }
}

}  // namespace roomradar
