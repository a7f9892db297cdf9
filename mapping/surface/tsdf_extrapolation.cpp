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

// Distances of a brick and of two samples beyond each of its six faces.
struct BrickWindow {
  static constexpr int kBeyond = 2, kEdge = kBrickEdge + 2 * kBeyond;
  static constexpr std::array<int, 3> kSteps{1, kEdge, kEdge* kEdge};  // along each axis

  std::array<float, kEdge * kEdge * kEdge> distance_m;
  std::array<bool, kEdge * kEdge * kEdge> is_known{};  // those beside the brick's edges stay unknown

  // Index of a sample relative to the brick's lowest.
  static int index_of(int x, int y, int z) {
    return x + kBeyond + kEdge * (y + kBeyond + kEdge * (z + kBeyond));
  }
};

// Copies the samples from `low` to below `high`, both relative to the brick's lowest, from the brick that is
// `from` bricks away.
void copy_samples(const TsdfBricks& bricks, std::size_t b, const Eigen::Vector3i& from,
                  const Eigen::Vector3i& low, const Eigen::Vector3i& high, BrickWindow& window) {
  const std::size_t brick = from.isZero() ? b : bricks.find(bricks.bricks()[b].first + kBrickEdge * from);
  for (int z = low.z(); z < high.z(); ++z)
    for (int y = low.y(); y < high.y(); ++y)
      for (int x = low.x(); x < high.x(); ++x) {
        const auto to = static_cast<std::size_t>(BrickWindow::index_of(x, y, z));
        window.is_known[to] = false;
        if (brick == TsdfBricks::kNone) continue;
        const TsdfSample& sample =
            bricks.bricks()[brick].samples[brick_offset(Eigen::Vector3i(x, y, z) - kBrickEdge * from)];
        window.is_known[to] = sample.known();
        window.distance_m[to] = sample.distance_m;
      }
}

void fill_window(const TsdfBricks& bricks, std::size_t b, BrickWindow& window) {
  const Eigen::Vector3i zero = Eigen::Vector3i::Zero(), edge = Eigen::Vector3i::Constant(kBrickEdge);
  copy_samples(bricks, b, zero, zero, edge, window);
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3i unit = Eigen::Vector3i::Unit(axis);
    copy_samples(bricks, b, unit, zero + kBrickEdge * unit, edge + BrickWindow::kBeyond * unit, window);
    copy_samples(bricks, b, -unit, zero - BrickWindow::kBeyond * unit, edge - kBrickEdge * unit, window);
  }
}

// Appends a sample for each unknown one next to a known one, in bricks begin..end-1.
void extrapolated_neighbours(const TsdfBricks& bricks, std::size_t begin, std::size_t end,
                             std::vector<ExtrapolatedSample>& samples) {
  BrickWindow window;
  for (std::size_t b = begin; b < end; ++b) {
    fill_window(bricks, b, window);
    for (std::size_t offset = 0; offset < kBrickSize; ++offset) {
      const int x = static_cast<int>(offset % kBrickEdge),
                y = static_cast<int>(offset / kBrickEdge % kBrickEdge),
                z = static_cast<int>(offset / (kBrickEdge * kBrickEdge));
      const int own = BrickWindow::index_of(x, y, z);
      if (window.is_known[static_cast<std::size_t>(own)] || bricks.bricks()[b].samples[offset].mirrored)
        continue;
      float on_lines = 0.0F, beside = 0.0F;  // sums of distances
      int lines = 0, count = 0;
      for (std::size_t side = 0; side < 6; ++side) {
        const int step = side % 2 == 0 ? BrickWindow::kSteps[side / 2] : -BrickWindow::kSteps[side / 2];
        const auto next = static_cast<std::size_t>(own + step),
                   beyond = static_cast<std::size_t>(own + 2 * step);
        if (!window.is_known[next]) continue;
        beside += window.distance_m[next];
        ++count;
        if (!window.is_known[beyond]) continue;
        on_lines += 2.0F * window.distance_m[next] - window.distance_m[beyond];
        ++lines;
      }
      if (count > 0)
        samples.push_back(
            {b, offset,
             lines > 0 ? on_lines / static_cast<float>(lines) : beside / static_cast<float>(count)});
    }
  }
}

// Returns the samples of all bricks; each entry has those of kBricksAtOnce bricks.
std::vector<std::vector<ExtrapolatedSample>> extrapolated_neighbours(const TsdfBricks& bricks) {
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
