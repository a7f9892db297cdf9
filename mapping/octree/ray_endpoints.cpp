// ray_endpoints.cpp: collects a frame's ray endpoints per leaf block.
#include "mapping/octree/ray_endpoints.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "mapping/octree/node_visibility.hpp"
#include "mapping/types/voxel_key.hpp"

namespace roomradar {
namespace {

constexpr int kNoKey = -1;

// Least-significant-digit radix sort by code, only over the bits that differ: a frame covers a small part of
// the tree.
void sort_by_code(std::vector<BlockHits>& hits, std::vector<BlockHits>& buffer) {
  constexpr int kDigitBits = 11;
  constexpr std::uint64_t kDigitMask = (1U << kDigitBits) - 1;
  std::uint64_t differing = 0;
  for (const BlockHits& hit : hits) differing |= hit.block_code() ^ hits.front().block_code();
  buffer.resize(hits.size());
  for (int shift = 0; shift < static_cast<int>(std::bit_width(differing)); shift += kDigitBits) {
    std::array<std::uint32_t, kDigitMask + 1> next{};
    for (const BlockHits& hit : hits) ++next[(hit.block_code() >> shift) & kDigitMask];
    std::uint32_t start = 0;
    for (std::uint32_t& count : next) start += std::exchange(count, start);
    for (const BlockHits& hit : hits) buffer[next[(hit.block_code() >> shift) & kDigitMask]++] = hit;
    hits.swap(buffer);
  }
}

// Merges the hits of each block into one entry.
void merge_sorted(std::vector<BlockHits>& hits) {
  std::size_t merged = 0;
  for (std::size_t i = 1; i < hits.size(); ++i) {
    if (hits[i].block_code() == hits[merged].block_code())
      hits[merged].add(hits[i].voxels());
    else
      hits[++merged] = hits[i];
  }
  if (!hits.empty()) hits.resize(merged + 1);
}

// Computes the endpoint keys of one image row as float offsets from the camera's own voxel, which is computed
// in double; precise enough anywhere in the tree.
struct RowOfRays {
  Eigen::Vector3f per_x, at_zero;  // voxels per metre of depth: direction(x) = per_x * ray_x + at_zero
  Eigen::Vector3f camera_within_voxel;
  Eigen::Vector3i camera_key;
  float max_range_m = 0.0F;
};

// Writes one coordinate of the keys, kNoKey for pixels without a hit. Returns non-zero if a key is out of
// range.
int end_voxels(const RowOfRays& rays, int axis, const float* depth_m, const float* ray_x, int width,
               int* keys) {
  const float per_x = rays.per_x[axis], at_zero = rays.at_zero[axis];
  const float within = rays.camera_within_voxel[axis], max_range_m = rays.max_range_m;
  const int camera_key = rays.camera_key[axis];
  int out_of_reach = 0;
  for (int x = 0; x < width; ++x) {
    const float z = depth_m[x];
    const float ahead_m = z > 0.0F ? z : 0.0F;  // -infinity and NaN cannot be cast to int
    const float within_range_m = ahead_m < max_range_m ? ahead_m : max_range_m;
    const float voxels = (per_x * ray_x[x] + at_zero) * within_range_m + within;
    const int truncated = static_cast<int>(voxels);
    const int key = truncated - (static_cast<float>(truncated) > voxels) + camera_key;
    const int hits = -static_cast<int>((z >= kLeastDepth_m) & (z <= max_range_m));  // all bits or none
    out_of_reach |= hits & key & ~0xFFFF;
    keys[x] = (hits & key) | (~hits & kNoKey);
  }
  return out_of_reach;
}

// Marks pixels whose voxel differs from that of the left and upper neighbour. Most neighbours share their
// voxel; remaining duplicates are merged after sorting.
void mark_new(const std::vector<int> (&above)[3], const std::vector<int> (&row)[3], int width,
              std::uint8_t* is_new) {
  // Each row has a kNoKey before its first pixel.
  const int *ax = above[0].data() + 1, *ay = above[1].data() + 1, *az = above[2].data() + 1;
  const int *x = row[0].data() + 1, *y = row[1].data() + 1, *z = row[2].data() + 1;
  for (int i = 0; i < width; ++i) {
    const int from_left = (x[i] ^ x[i - 1]) | (y[i] ^ y[i - 1]) | (z[i] ^ z[i - 1]);
    const int from_above = (x[i] ^ ax[i]) | (y[i] ^ ay[i]) | (z[i] ^ az[i]);
    is_new[i] = static_cast<std::uint8_t>((x[i] != kNoKey) & (from_left != 0) & (from_above != 0));
  }
}

// Collects the marked columns, with unconditional writes to avoid branch misprediction.
std::size_t marked(const std::vector<std::uint8_t>& is_new, std::vector<std::uint32_t>& columns) {
  std::size_t count = 0;
  for (std::size_t x = 0; x < is_new.size(); ++x) {
    columns[count] = static_cast<std::uint32_t>(x);
    count += is_new[x];
  }
  return count;
}

void add_hits(const std::vector<int> (&row)[3], const std::vector<std::uint32_t>& columns, std::size_t count,
              std::vector<BlockHits>& hits) {
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t x = columns[n] + 1;
    const auto key_x = static_cast<unsigned>(row[0][x]), key_y = static_cast<unsigned>(row[1][x]),
               key_z = static_cast<unsigned>(row[2][x]);
    const unsigned voxel = 1U << ((key_x & 1U) | (key_y & 1U) << 1U | (key_z & 1U) << 2U);
    hits.emplace_back(morton_code(key_x >> 1U, key_y >> 1U, key_z >> 1U), voxel);
  }
}

}  // namespace

HitStatus collect_hits(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                       const FusionConfig& config, FusionScratch& scratch) {
  const Intrinsics& camera = frame.depth_camera;
  const DepthImage& depth_m = frame.depth_m;
  const auto is_measured = [](float z) { return z >= kLeastDepth_m; };
  if (std::none_of(depth_m.pixels.begin(), depth_m.pixels.end(), is_measured)) return HitStatus::kNone;
  const Eigen::Matrix3f R_voxels = (T_world_camera.linear() / resolution_m).cast<float>();
  const Eigen::Vector3d camera_voxels = T_world_camera.translation() / resolution_m;
  if (!(camera_voxels.cwiseAbs().maxCoeff() < 1e6)) return HitStatus::kOutOfBounds;
  const Eigen::Vector3i camera_voxel = camera_voxels.array().floor().cast<int>();
  RowOfRays rays;
  rays.per_x = R_voxels.col(0);
  rays.camera_within_voxel = (camera_voxels - camera_voxel.cast<double>()).cast<float>();
  rays.camera_key = camera_voxel.array() + kKeyOrigin;
  rays.max_range_m = config.max_range_m;

  const int width = depth_m.width;
  const auto columns = static_cast<std::size_t>(width);
  scratch.hits.clear();
  scratch.is_new.resize(columns);
  scratch.columns.resize(columns + 1);
  scratch.ray_x.resize(columns);
  for (int x = 0; x < width; ++x)
    scratch.ray_x[static_cast<std::size_t>(x)] = static_cast<float>((x - camera.cx_px) / camera.fx_px);
  for (auto& row : scratch.row_keys)
    for (std::vector<int>& keys : row) keys.assign(columns + 1, kNoKey);
  for (int y = 0; y < depth_m.height; ++y) {
    auto& above = scratch.row_keys[y % 2];
    auto& row = scratch.row_keys[1 - y % 2];
    rays.at_zero = R_voxels.col(1) * static_cast<float>((y - camera.cy_px) / camera.fy_px) + R_voxels.col(2);
    int out_of_reach = 0;
    for (int axis = 0; axis < 3; ++axis)
      out_of_reach |=
          end_voxels(rays, axis, depth_m.row(y), scratch.ray_x.data(), width, row[axis].data() + 1);
    if (out_of_reach != 0) return HitStatus::kOutOfBounds;
    mark_new(above, row, width, scratch.is_new.data());
    add_hits(row, scratch.columns, marked(scratch.is_new, scratch.columns), scratch.hits);
  }
  if (!scratch.hits.empty()) sort_by_code(scratch.hits, scratch.sort_buffer);
  merge_sorted(scratch.hits);
  return HitStatus::kCollected;
}

}  // namespace roomradar
