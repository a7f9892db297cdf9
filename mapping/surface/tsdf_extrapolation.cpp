// tsdf_extrapolation.cpp: extrapolates two layers around the measured samples.
#include "mapping/surface/tsdf_extrapolation.hpp"

#include <array>
#include <limits>
#include <vector>

#include "mapping/types/system/parallel_for.hpp"

namespace roomradar {
namespace {

struct ExtrapolatedSample {
  std::size_t brick;
  std::size_t offset;
  float distance_m;
};

const TsdfSample* known_at(const std::vector<Brick>& bricks, const BrickNeighbourhood::SampleIndex& index) {
  if (index.brick == TsdfBricks::kNone) return nullptr;
  const TsdfSample& sample = bricks[index.brick].samples[index.offset];
  return sample.known() ? &sample : nullptr;
}

// Appends a sample for each unknown one next to a known one, in bricks begin..end-1.
void extrapolated_neighbours(const TsdfBricks& bricks, std::size_t begin, std::size_t end,
                             std::vector<ExtrapolatedSample>& samples) {
  const std::vector<Brick>& all = bricks.bricks();
  for (std::size_t b = begin; b < end; ++b) {
    const BrickNeighbourhood around(bricks, b);
    for (int z = 0; z < kBrickEdge; ++z)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int x = 0; x < kBrickEdge; ++x) {
          const Eigen::Vector3i voxel(x, y, z);
          const TsdfSample& own = all[b].samples[brick_offset(voxel)];
          if (own.known() || own.mirrored) continue;
          float on_lines = 0.0F, beside = 0.0F;  // sums of distances
          int lines = 0, count = 0;
          for (int side = 0; side < 6; ++side) {
            const Eigen::Vector3i step = (side % 2 == 0 ? 1 : -1) * Eigen::Vector3i::Unit(side / 2);
            const TsdfSample* next = known_at(all, around.index_of(voxel + step));
            if (!next) continue;
            const TsdfSample* beyond = known_at(all, around.index_of(voxel + 2 * step));
            beside += next->distance_m;
            ++count;
            if (!beyond) continue;
            on_lines += 2.0F * next->distance_m - beyond->distance_m;
            ++lines;
          }
          if (count > 0)
            samples.push_back(
                {b, brick_offset(voxel),
                 lines > 0 ? on_lines / static_cast<float>(lines) : beside / static_cast<float>(count)});
        }
  }
}

// Returns the samples of all bricks; each entry has those of kBricksAtOnce bricks.
std::vector<std::vector<ExtrapolatedSample>> extrapolated_neighbours(const TsdfBricks& bricks) {
  constexpr std::size_t kBricksAtOnce = 64;
  const std::size_t count = bricks.bricks().size();
  std::vector<std::vector<ExtrapolatedSample>> samples((count + kBricksAtOnce - 1) / kBricksAtOnce);
  parallel_ranges(count, kBricksAtOnce, [&](std::size_t begin, std::size_t end) {
    extrapolated_neighbours(bricks, begin, end, samples[begin / kBricksAtOnce]);
  });
  return samples;
}

void store(const std::vector<std::vector<ExtrapolatedSample>>& samples, TsdfBricks& bricks) {
  for (const std::vector<ExtrapolatedSample>& some : samples)
    for (const ExtrapolatedSample& one : some) {
      TsdfSample& sample = bricks.bricks()[one.brick].samples[one.offset];
      sample.distance_m = one.distance_m;
      sample.weight = std::numeric_limits<float>::min();
      sample.extrapolated = true;
    }
}

}  // namespace

void extrapolate_neighbours(TsdfLevels& levels) {
  for (int ring = 0; ring < 2; ++ring) {
    const std::vector<std::vector<ExtrapolatedSample>> in_voxels = extrapolated_neighbours(levels.voxels);
    store(extrapolated_neighbours(levels.coarse), levels.coarse);
    store(in_voxels, levels.voxels);
    levels.mirror_voxels_in_coarse();
    levels.mirror_coarse_in_voxels();
  }
}

}  // namespace roomradar
