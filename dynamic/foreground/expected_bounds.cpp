// expected_bounds.cpp: per block of the expected depth: standard deviation from noise and slope, and edges
// within reach.
#include "dynamic/foreground/expected_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/disjoint_sets.hpp"

namespace roomradar {
namespace {

constexpr int kMaxReach = 6;       // blocks to each side
constexpr float kGrazing = 5.67F;  // depth per width of a surface seen at 80 degrees from its normal
// Max relative depth change of a smooth surface within reach: a table seen at 60 degrees from its normal.
constexpr float kSteepest = 0.1F;

struct Nearer {
  float operator()(float a, float b) const { return b < a ? b : a; }
};
struct Farther {
  float operator()(float a, float b) const { return b > a ? b : a; }
};

// Computes the nearest and farthest expected depth of each block.
void find_extremes(const DepthImage& expected_m, ExpectedBounds& bounds) {
  const auto width = static_cast<std::size_t>(bounds.grid.columns) * kBlock_px;
  bounds.nearest_m.resize(bounds.grid.size());
  bounds.farthest_m.resize(bounds.grid.size());
  for (int row = 0; row < bounds.grid.rows; ++row) {
    bounds.row_nearest_m.assign(width, kNoDepth_m);
    bounds.row_farthest_m.assign(width, 0.0F);
    float* nearest = bounds.row_nearest_m.data();
    float* farthest = bounds.row_farthest_m.data();
    for (int y = row * kBlock_px; y < std::min((row + 1) * kBlock_px, expected_m.height); ++y) {
      const float* expected = expected_m.row(y);
      for (int x = 0; x < expected_m.width; ++x) {
        const float z = expected[x];
        nearest[x] = Nearer{}(nearest[x], z > 0.0F ? z : kNoDepth_m);
        farthest[x] = Farther{}(farthest[x], z);
      }
    }
    for (int column = 0; column < bounds.grid.columns; ++column) {
      const float* n = nearest + column * kBlock_px;
      const float* f = farthest + column * kBlock_px;
      bounds.nearest_m[bounds.grid.at(column, row)] = std::min(std::min(n[0], n[1]), std::min(n[2], n[3]));
      bounds.farthest_m[bounds.grid.at(column, row)] = std::max(std::max(f[0], f[1]), std::max(f[2], f[3]));
    }
  }
}

// Computes how many blocks to each side an edge may be shifted. A rotation error shifts all edges alike; a
// translation error and the map's distortion shift near edges more. Composed of the steps that `spread`
// allows.
void choose_reach(const Intrinsics& camera, const ForegroundConfig& config, ExpectedBounds& bounds) {
  spread(bounds.grid, bounds.nearest_m, 1, Nearer{}, bounds.along_rows_m, bounds.nearest_level_m);
  spread(bounds.grid, bounds.nearest_level_m, 2, Nearer{}, bounds.along_rows_m, bounds.nearest_level_m);
  spread(bounds.grid, bounds.nearest_level_m, 3, Nearer{}, bounds.along_rows_m, bounds.nearest_level_m);
  const float focal_px = static_cast<float>(std::max(camera.fx_px, camera.fy_px));
  bounds.reach.resize(bounds.grid.size());
  for (std::size_t i = 0; i < bounds.reach.size(); ++i) {
    const float edge_px =
        focal_px * (config.edge_error_rad + config.edge_error_m / bounds.nearest_level_m[i]);
    const int blocks = static_cast<int>(std::min(edge_px / kBlock_px, static_cast<float>(kMaxReach) - 0.5F));
    bounds.reach[i] = blocks + 1;
  }
}

// Computes the extremes within each block's reach.
void find_extremes_in_reach(ExpectedBounds& bounds) {
  bounds.nearest_in_reach_m.resize(bounds.grid.size());
  bounds.farthest_in_reach_m.resize(bounds.grid.size());
  bounds.nearest_level_m = bounds.nearest_m;
  bounds.farthest_level_m = bounds.farthest_m;
  // Through a hole of the model the sensor may see to an unknown distance.
  for (std::size_t i = 0; i < bounds.model_m.size(); ++i)
    if (!(bounds.model_m[i] > 0.0F)) bounds.farthest_level_m[i] = kNoDepth_m;
  for (int reach = 1; reach <= kMaxReach; ++reach) {
    spread(bounds.grid, bounds.nearest_level_m, 1, Nearer{}, bounds.along_rows_m, bounds.nearest_level_m);
    spread(bounds.grid, bounds.farthest_level_m, 1, Farther{}, bounds.along_rows_m, bounds.farthest_level_m);
    for (std::size_t i = 0; i < bounds.reach.size(); ++i) {
      const bool is_it = bounds.reach[i] == reach;
      bounds.nearest_in_reach_m[i] = is_it ? bounds.nearest_level_m[i] : bounds.nearest_in_reach_m[i];
      bounds.farthest_in_reach_m[i] = is_it ? bounds.farthest_level_m[i] : bounds.farthest_in_reach_m[i];
    }
  }
}

// Marks the small surfaces that holes separate from the rest of the model.
void find_islands(ExpectedBounds& bounds) {
  constexpr std::size_t kMostOfAll = 50;  // an island has at most a fiftieth of the image
  const BlockGrid& grid = bounds.grid;
  std::vector<ExpectedBounds::BlockRun>& runs = bounds.runs;
  runs.clear();
  const auto root_of = [&](std::size_t run) {
    return find_root(run, [&](std::size_t of) -> std::size_t& { return runs[of].parent; });
  };
  std::size_t above = 0;
  for (int row = 0; row < grid.rows; ++row) {
    const std::size_t row_begin = runs.size();
    std::size_t other = above;
    const float* farthest = bounds.farthest_m.data() + grid.at(0, row);
    for (int column = 0; column < grid.columns; ++column) {
      if (!(farthest[column] > 0.0F)) continue;
      const int first = column;
      while (column + 1 < grid.columns && farthest[column + 1] > 0.0F) ++column;
      const std::size_t id = runs.size();
      runs.push_back({row, first, column, id, static_cast<std::size_t>(column - first + 1)});
      while (other < row_begin && runs[other].last < first - 1) ++other;
      for (std::size_t touching = other; touching < row_begin && runs[touching].first <= column + 1;
           ++touching) {
        const std::size_t a = root_of(id), b = root_of(touching);
        if (a == b) continue;
        runs[std::max(a, b)].parent = std::min(a, b);
        runs[std::min(a, b)].blocks += runs[std::max(a, b)].blocks;
      }
    }
    above = row_begin;
  }
  bounds.is_island.assign(grid.size(), 0);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (kMostOfAll * runs[root_of(i)].blocks > grid.size()) continue;
    const auto begin = bounds.is_island.begin() + static_cast<std::ptrdiff_t>(grid.at(0, runs[i].row));
    std::fill(begin + runs[i].first, begin + runs[i].last + 1, std::uint8_t{1});
  }
}

void find_extremes_around_holes(int reach_px, ExpectedBounds& bounds) {
  bounds.nearest_around_hole_m = bounds.nearest_m;
  for (std::size_t i = 0; i < bounds.is_island.size(); ++i)
    if (bounds.is_island[i] != 0) bounds.nearest_around_hole_m[i] = kNoDepth_m;
  int reach = 0;
  for (const int wanted = blocks_along(reach_px); reach < wanted;) {
    const int step = std::min(2 * reach + 1, wanted - reach);
    spread(bounds.grid, bounds.nearest_around_hole_m, step, Nearer{}, bounds.along_rows_m,
           bounds.nearest_around_hole_m);
    reach += step;
  }
  // Wider holes: the nearest of the values from above, and of those from below.
  const BlockGrid& grid = bounds.grid;
  std::vector<float>& around = bounds.nearest_around_hole_m;
  if (std::find(around.begin(), around.end(), kNoDepth_m) == around.end()) return;
  std::vector<float>& from_below = bounds.nearest_level_m;
  from_below = around;
  const auto fill = [&](std::vector<float>& values, int column, int row, int step) {
    float& value = values[grid.at(column, row)];
    if (value != kNoDepth_m) return;
    if (column - step >= 0 && column - step < grid.columns)
      value = std::min(value, values[grid.at(column - step, row)]);
    if (row - step < 0 || row - step >= grid.rows) return;
    for (int u = std::max(column - 1, 0); u <= std::min(column + 1, grid.columns - 1); ++u)
      value = std::min(value, values[grid.at(u, row - step)]);
  };
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) fill(around, column, row, 1);
  for (int row = grid.rows - 1; row >= 0; --row)
    for (int column = grid.columns - 1; column >= 0; --column) fill(from_below, column, row, -1);
  for (std::size_t i = 0; i < around.size(); ++i) around[i] = std::min(around[i], from_below[i]);
}

// Adds the background to the blocks without a model.
void add_background(const UnmappedSpace& unmapped, ExpectedBounds& bounds) {
  bounds.background_m.resize(bounds.grid.size());
  for (std::size_t i = 0; i < bounds.model_m.size(); ++i) {
    bounds.background_m[i] = bounds.model_m[i] > 0.0F ? 0.0F : unmapped.farthest[i].depth_m;
    if (!(bounds.background_m[i] > 0.0F)) continue;
    bounds.nearest_m[i] = bounds.farthest_m[i] = bounds.background_m[i];
  }
}

// Returns the angle whose cosine (0..1) is given, within 7e-5 rad, without a library call. Source: Abramowitz
// and Stegun, Handbook of Mathematical Functions, 4.4.45.
inline float arc_cosine(float cosine) {
  return std::sqrt(1.0F - cosine) *
         (1.5707288F + cosine * (-0.2121144F + cosine * (0.0742610F - 0.0187293F * cosine)));
}

// Returns the flatter of two slopes, so a depth discontinuity on one side does not count as a slope.
inline float flatter(float a, float b) { return std::abs(a) < std::abs(b) ? a : b; }

// Computes the error of each block's surface, and whether everything within reach is a continuation of it.
void weigh_surfaces(const Intrinsics& camera, const ForegroundConfig& settings, float misfit_per_m,
                    ExpectedBounds& bounds) {
  const ForegroundConfig config = settings;  // a copy, so the compiler sees that no loop writes to it
  const BlockGrid grid = bounds.grid;
  bounds.sigma_m.resize(grid.size());
  const auto fx = static_cast<float>(camera.fx_px);
  const auto fy = static_cast<float>(camera.fy_px);
  const float focal_px = std::max(fx, fy);
  const float per_step = 1.0F / kBlock_px;
  for (int row = 0; row < grid.rows; ++row) {
    // The farthest depth of each block: slopes are unaffected, and at edges the noisier side counts.
    const float* middle = bounds.farthest_m.data() + grid.at(0, row);
    const float* above = bounds.farthest_m.data() + grid.at(0, std::max(row - 1, 0));
    const float* below = bounds.farthest_m.data() + grid.at(0, std::min(row + 1, grid.rows - 1));
    const float* nearest_in_block = bounds.nearest_m.data() + grid.at(0, row);
    const float* background = bounds.background_m.data() + grid.at(0, row);
    const int* reach = bounds.reach.data() + grid.at(0, row);
    float* sigma = bounds.sigma_m.data() + grid.at(0, row);
    float* nearest = bounds.nearest_in_reach_m.data() + grid.at(0, row);
    float* farthest = bounds.farthest_in_reach_m.data() + grid.at(0, row);
    const float v = (static_cast<float>(row) + 0.5F) * kBlock_px - static_cast<float>(camera.cy_px);
    const float v_ray2 = v * v / (fy * fy) + 1.0F;
    for (int column = 0; column < grid.columns; ++column) {
      // For depth z(u, v) the surface normal is (fx z_u, fy z_v, -(z + u z_u + v z_v)), u and v relative to
      // the principal point. Its dot product with the viewing ray (u / fx, v / fy, 1) is -z.
      const float z = middle[column];
      const float left = middle[std::max(column - 1, 0)];
      const float right = middle[std::min(column + 1, grid.columns - 1)];
      const float u = (static_cast<float>(column) + 0.5F) * kBlock_px - static_cast<float>(camera.cx_px);
      const float slope_u = flatter(z - left, right - z) * per_step;
      const float slope_v = flatter(z - above[column], below[column] - z) * per_step;
      const float normal_x = fx * slope_u;
      const float normal_y = fy * slope_v;
      const float normal_z = z + u * slope_u + v * slope_v;
      const float normal2 = normal_x * normal_x + normal_y * normal_y + normal_z * normal_z;
      const float cosine = z / std::sqrt(normal2 * (u * u / (fx * fx) + v_ray2) + 1e-12F);
      const float sensor = depth_sigma_m(config.noise, z, arc_cosine(cosine < 1.0F ? cosine : 1.0F));
      const float model = config.model_sigma_m;
      const float misfit = misfit_per_m * z * z;
      const float slope = std::min(std::abs(slope_u) + std::abs(slope_v), kGrazing * z / focal_px);
      const float pose = slope * focal_px * (config.pose_sigma_rad + config.pose_sigma_m / (z + 1e-6F));
      // One depth stands for a whole block of the background, and is up to half a block off.
      const float block = background[column] > 0.0F ? 0.5F * kBlock_px * slope : 0.0F;
      sigma[column] =
          std::sqrt(sensor * sensor + model * model + misfit * misfit + pose * pose + block * block);

      // A plane's inverse depth is linear in the image; over this many pixels it changes by at most this
      // much.
      const float inverse = 1.0F / (z + 1e-6F);
      // A steeper surface may be an edge itself.
      const float change =
          std::min(slope * inverse * inverse * static_cast<float>((reach[column] + 1) * kBlock_px),
                   kSteepest * inverse);
      const float slack = config.weak_sigmas * sigma[column];
      const bool none_nearer = nearest[column] > 1.0F / (inverse + change) - slack;
      const float at_least = 1.0F / nearest_in_block[column];
      const bool none_farther = (farthest[column] - slack) * (at_least - change) < 1.0F;
      nearest[column] = none_nearer ? kNoDepth_m : nearest[column];
      farthest[column] = none_farther ? 0.0F : farthest[column];
    }
  }
}

}  // namespace

void find_bounds(const PosedDepth& expected, const ForegroundConfig& config, float misfit_per_m,
                 UnmappedSpace& unmapped, ExpectedBounds& bounds) {
  const DepthImage& expected_m = expected.depth_m;
  const Intrinsics& camera = expected.camera;
  bounds.grid = {blocks_along(expected_m.width), blocks_along(expected_m.height)};
  find_extremes(expected_m, bounds);
  bounds.model_m = bounds.farthest_m;
  find_islands(bounds);
  find_extremes_around_holes(config.hole_reach_px, bounds);
  warp_unmapped(camera, expected.T_world_camera, bounds.model_m, unmapped);
  add_background(unmapped, bounds);
  choose_reach(camera, config, bounds);
  find_extremes_in_reach(bounds);
  weigh_surfaces(camera, config, misfit_per_m, bounds);
}

}  // namespace roomradar
