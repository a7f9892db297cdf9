// depth_agreement.cpp: agreement of a depth image with the depth expected at a pose.
#include "mapping/localization/depth_agreement.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {

DepthAgreement depth_agreement_of(const DepthImage& depth_m, const DepthImage& expected_m) {
  constexpr int kStep_px = 4;
  constexpr float kAlike_per_m = 0.02F;  // in inverse depth; 5 steps of a Kinect's disparity are 0.014
  constexpr float kAlike_m = 0.006F;     // nearer than 0.55 m, a map's voxels of 1 cm are coarser than that
  DepthAgreement agreement;
  for (int y = 0; y < depth_m.height; y += kStep_px) {
    for (int x = 0; x < depth_m.width; x += kStep_px) {
      const float live = depth_m.at(x, y), expected = expected_m.at(x, y);
      if (!(live > 0.0F)) continue;
      ++agreement.valid;
      if (!(expected > 0.0F)) continue;
      ++agreement.both;
      const float gap_m = std::max(kAlike_per_m * live * expected, kAlike_m);
      agreement.alike += std::abs(live - expected) < gap_m;
      agreement.farther += live - expected >= gap_m;
    }
  }
  return agreement;
}

}  // namespace roomradar
