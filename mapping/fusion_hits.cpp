// fusion_hits.cpp: the voxels that a frame's rays end in, as sorted Morton codes.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

#include "mapping/fusion.hpp"
#include "mapping/types/morton.hpp"

namespace roomradar {
namespace {

constexpr std::uint64_t kNoKey = ~std::uint64_t{0};

// Least-significant-digit radix sort, over the bits that differ at all: a frame sees a small part of the
// tree.
void sort_codes(std::vector<std::uint64_t>& codes, std::vector<std::uint64_t>& buffer) {
  constexpr int kDigitBits = 11;
  constexpr std::uint64_t kDigitMask = (1U << kDigitBits) - 1;
  std::uint64_t differing = 0;
  for (const std::uint64_t code : codes) differing |= code ^ codes.front();
  buffer.resize(codes.size());
  for (int shift = 0; shift < static_cast<int>(std::bit_width(differing)); shift += kDigitBits) {
    std::array<std::uint32_t, kDigitMask + 1> next{};
    for (const std::uint64_t code : codes) ++next[(code >> shift) & kDigitMask];
    std::uint32_t start = 0;
    for (std::uint32_t& count : next) start += std::exchange(count, start);
    for (const std::uint64_t code : codes) buffer[next[(code >> shift) & kDigitMask]++] = code;
    codes.swap(buffer);
  }
}

}  // namespace

HitStatus collect_hits(const Frame& frame, const Eigen::Isometry3d& T_world_camera, double resolution_m,
                       const FusionConfig& config, FusionScratch& scratch) {
  const Intrinsics& camera = frame.depth_camera;
  const DepthImage& depth_m = frame.depth_m;
  // Keys are float offsets from the camera's own voxel, which is found in double: exact enough anywhere in
  // the tree.
  const Eigen::Matrix3f R_voxels = (T_world_camera.linear() / resolution_m).cast<float>();
  const Eigen::Vector3d camera_voxels = T_world_camera.translation() / resolution_m;
  if (!(camera_voxels.cwiseAbs().maxCoeff() < 1e6)) return HitStatus::kOutOfReach;
  const Eigen::Vector3i camera_key = camera_voxels.array().floor().cast<int>();
  const Eigen::Vector3f within_voxel = (camera_voxels - camera_key.cast<double>()).cast<float>();
  const Eigen::Array3i first_key = camera_key.array() + kKeyOrigin;
  const auto inverse_fx = static_cast<float>(1.0 / camera.fx_px);

  scratch.hits.clear();
  scratch.row_keys.assign(static_cast<std::size_t>(depth_m.width), kNoKey);
  bool measured = false;
  for (int y = 0; y < depth_m.height; ++y) {
    const float* row = depth_m.row(y);
    const auto ray_y = static_cast<float>((y - camera.cy_px) / camera.fy_px);
    const Eigen::Vector3f row_direction = R_voxels.col(1) * ray_y + R_voxels.col(2);
    std::uint64_t left = kNoKey;
    for (int x = 0; x < depth_m.width; ++x) {
      const float z = row[x];
      std::uint64_t& above = scratch.row_keys[static_cast<std::size_t>(x)];
      if (!(z > 0.0F)) {
        above = kNoKey;
        continue;
      }
      measured = true;
      if (z > config.max_range_m) {
        above = kNoKey;
        continue;
      }
      const float ray_x = (static_cast<float>(x) - static_cast<float>(camera.cx_px)) * inverse_fx;
      const Eigen::Array3f voxels = (R_voxels.col(0) * ray_x + row_direction) * z + within_voxel;
      const Eigen::Array3i key = voxels.floor().cast<int>() + first_key;
      if ((key < 0).any() || (key > 0xFFFF).any()) return HitStatus::kOutOfReach;
      const std::uint64_t packed = static_cast<std::uint64_t>(key.x()) |
                                   static_cast<std::uint64_t>(key.y()) << 16U |
                                   static_cast<std::uint64_t>(key.z()) << 32U;
      // Most neighbours share their voxel; what still comes twice goes after sorting.
      if (packed != left && packed != above)
        scratch.hits.push_back(morton_code(static_cast<std::uint32_t>(key.x()),
                                           static_cast<std::uint32_t>(key.y()),
                                           static_cast<std::uint32_t>(key.z())));
      left = above = packed;
    }
  }
  if (!measured) return HitStatus::kNone;
  if (!scratch.hits.empty()) sort_codes(scratch.hits, scratch.sort_buffer);
  scratch.hits.erase(std::unique(scratch.hits.begin(), scratch.hits.end()), scratch.hits.end());
  return HitStatus::kCollected;
}

}  // namespace roomradar
