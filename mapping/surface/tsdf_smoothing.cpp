// tsdf_smoothing.cpp: Gauss-Seidel sweeps over bricks of samples.
#include "mapping/surface/tsdf_smoothing.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace roomradar {
namespace {

// Samples with a weight above this many times the strength are skipped: they would move by less than a tenth
// of the difference to their neighbours.
constexpr float kFirm = 30.0F;

struct Stencil {
  std::size_t axis;
  int step;  // index step in a brick's arrays
};
constexpr std::array<Stencil, 3> kAxes{{{0, 1}, {1, kBrickEdge}, {2, kBrickEdge* kBrickEdge}}};

struct NeighbourBricks {
  std::array<std::size_t, 3> before{};
  std::array<std::size_t, 3> after{};
};

}  // namespace

void smooth(TsdfBricks& bricks, float strength, int sweeps) {
  std::vector<Brick>& all = bricks.bricks();
  std::vector<NeighbourBricks> neighbours(all.size());
  std::vector<std::array<float, kBrickSize>> measured_m(all.size());
  for (std::size_t b = 0; b < all.size(); ++b) {
    for (std::size_t a = 0; a < 3; ++a) {
      const VoxelIndex step = kBrickEdge * VoxelIndex::Unit(static_cast<Eigen::Index>(a));
      neighbours[b].before[a] = bricks.find(all[b].first - step);
      neighbours[b].after[a] = bricks.find(all[b].first + step);
    }
    for (std::size_t i = 0; i < kBrickSize; ++i) measured_m[b][i] = all[b].samples[i].distance_m;
  }
  // The sample one step from i along an axis, in brick b or the next; null if unknown.
  const auto neighbour = [&](std::size_t beyond, std::size_t b, std::size_t i, int step,
                             bool leaves_brick) -> const TsdfSample* {
    const std::size_t brick = leaves_brick ? beyond : b;
    if (brick == TsdfBricks::kNone) return nullptr;
    const auto at = static_cast<int>(i) + (leaves_brick ? -(kBrickEdge - 1) * step : step);
    const TsdfSample& found = all[brick].samples[static_cast<std::size_t>(at)];
    return found.known() ? &found : nullptr;
  };
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t b = 0; b < all.size(); ++b)
      for (std::size_t i = 0; i < kBrickSize; ++i) {
        TsdfSample& sample = all[b].samples[i];
        if (!sample.known() || sample.weight > kFirm * strength) continue;
        float sum = sample.weight * measured_m[b][i];
        float weight = sample.weight;
        for (const auto& [axis, step] : kAxes) {
          const int coordinate = static_cast<int>(i) / step % kBrickEdge;
          const TsdfSample* before = neighbour(neighbours[b].before[axis], b, i, -step, coordinate == 0);
          if (!before) continue;
          const TsdfSample* after =
              neighbour(neighbours[b].after[axis], b, i, step, coordinate == kBrickEdge - 1);
          if (!after) continue;
          sum += strength * 0.5F * (before->distance_m + after->distance_m);
          weight += strength;
        }
        sample.distance_m = sum / weight;
      }
}

}  // namespace roomradar
