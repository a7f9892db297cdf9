// reduced_depth.cpp: finds the dominant surface of each block, and averages its inverse depth.
#include "dynamic/surface/reduced_depth.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "dynamic/surface/depth_discontinuity.hpp"

namespace roomradar {
namespace {

constexpr int kLeastSide_px = 32;
constexpr float kJumpSigmas = 4.0F, kJumpIncidence_deg = 80.0F;  // as in the mesh of dynamic surfaces

/// The surface to which most of the inverse depths belong. An inverse depth of 0 means none.
template <std::size_t kCount>
float most_shown(std::array<float, kCount>& inverse, const DepthDiscontinuity& jump) {
  std::sort(inverse.begin(), inverse.end(), std::greater<>());
  float best_sum = 0.0F, sum = 0.0F;
  int best = 0, count = 0;
  float before = 0.0F;
  for (const float q : inverse) {
    if (!(q > 0.0F)) break;
    if (count > 0 && !jump.is_one_surface_inverse(before, q)) {
      count = 0;
      sum = 0.0F;
    }
    ++count;
    sum += q;
    before = q;
    if (count <= best) continue;  // of equally many the nearer
    best = count;
    best_sum = sum;
  }
  return 2 * best >= static_cast<int>(kCount) ? static_cast<float>(best) / best_sum : 0.0F;
}

template <int kStride>
void reduce(const DepthImage& depth_m, const DepthDiscontinuity& jump, DepthImage& reduced_m) {
  constexpr std::size_t kCount = std::size_t{kStride} * kStride;
  const float least_jump = jump.least_jump();
  for (int y = 0; y < reduced_m.height; ++y) {
    float* out = reduced_m.row(y);
    for (int x = 0; x < reduced_m.width; ++x) {
      std::array<float, kCount> inverse;
      float nearest = 0.0F, farthest = 1e30F, sum = 0.0F;
      for (int dy = 0; dy < kStride; ++dy) {
        const float* in = depth_m.row(y * kStride + dy) + x * kStride;
        for (int dx = 0; dx < kStride; ++dx) {
          const float q = in[dx] > 0.0F ? 1.0F / in[dx] : 0.0F;
          inverse[static_cast<std::size_t>(dy * kStride + dx)] = q;
          nearest = std::max(nearest, q);
          farthest = std::min(farthest, q);
          sum += q;
        }
      }
      const bool is_one_surface = nearest - farthest <= least_jump * farthest;
      out[x] = !(nearest > 0.0F) ? 0.0F
               : is_one_surface  ? static_cast<float>(kCount) / sum
                                 : most_shown(inverse, jump);
    }
  }
}

}  // namespace

int usable_stride(const Intrinsics& depth_camera, int stride) {
  while (stride > 1 && std::min(depth_camera.width_px, depth_camera.height_px) / stride < kLeastSide_px)
    stride /= 2;
  return stride;
}

void reduce_depth(const Frame& frame, int stride, Frame& reduced) {
  reduced.depth_camera = scaled(frame.depth_camera, 1.0 / stride);
  const DepthDiscontinuity jump(frame.depth_noise, kJumpSigmas, kJumpIncidence_deg, 1.0F, frame.depth_camera);
  reduced.depth_m.resize(reduced.depth_camera.width_px, reduced.depth_camera.height_px);
  if (stride == 4)
    reduce<4>(frame.depth_m, jump, reduced.depth_m);
  else if (stride == 2)
    reduce<2>(frame.depth_m, jump, reduced.depth_m);
  else
    reduced.depth_m.pixels = frame.depth_m.pixels;
}

}  // namespace roomradar
