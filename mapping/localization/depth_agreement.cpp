// depth_agreement.cpp: agreement of a depth image with the depth expected at a pose.
#include "mapping/localization/depth_agreement.hpp"

#include <cmath>

namespace roomradar {

DepthAgreement depth_agreement_of(const DepthImage& depth_m, const DepthImage& expected_m) {
  constexpr int kStep_px = 4;
  constexpr float kAlike_per_m = 0.02F;  // in inverse depth; 5 steps of a Kinect's disparity are 0.014
  DepthAgreement agreement;
  for (int y = 0; y < depth_m.height; y += kStep_px) {
    for (int x = 0; x < depth_m.width; x += kStep_px) {
      const float live = depth_m.at(x, y), expected = expected_m.at(x, y);
      if (!(live > 0.0F)) continue;
      ++agreement.valid;
      if (!(expected > 0.0F)) continue;
      ++agreement.both;
      const float gap_m = kAlike_per_m * live * expected;
      agreement.alike += std::abs(live - expected) < gap_m;
      agreement.farther += live - expected >= gap_m;
    }
  }
  return agreement;
}

}  // namespace roomradar
