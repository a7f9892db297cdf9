// static_residual.cpp: standard deviation of measured minus expected inverse depth, from a histogram
// quantile.
#include "dynamic/foreground/static_residual.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/types/depth_noise.hpp"

namespace roomradar {

void follow_misfit(const DepthImage& depth_m, const DepthImage& expected_m, const DepthNoise& noise,
                   StaticResidual& fit) {
  constexpr int kStep_px = 8;
  constexpr int kLeastSamples = 100;
  constexpr float kLargest_per_m = 0.03F;
  constexpr float kLeast_per_m = 0.0006F, kMost_per_m = 0.007F;
  constexpr float kShrink = 0.1F;      // fraction of the difference, per frame
  constexpr double kOneSigma = 0.683;  // fraction of a normal distribution within one sigma
  const float bins_per_m = static_cast<float>(fit.histogram.size()) / kLargest_per_m;

  fit.histogram.fill(0);
  int samples = 0;
  double noise2 = 0.0;
  for (int y = kStep_px / 2; y < depth_m.height; y += kStep_px) {
    const float* live = depth_m.row(y);
    const float* expected = expected_m.row(y);
    for (int x = kStep_px / 2; x < depth_m.width; x += kStep_px) {
      if (!(live[x] > 0.0F) || !(expected[x] > 0.0F)) continue;
      const float apart = std::abs(live[x] - expected[x]) / (live[x] * expected[x]);
      if (apart >= kLargest_per_m) continue;
      ++fit.histogram[std::min(static_cast<std::size_t>(apart * bins_per_m), fit.histogram.size() - 1)];
      const float sigma_per_m = depth_sigma_m(noise, expected[x]) / (expected[x] * expected[x]);
      noise2 += sigma_per_m * sigma_per_m;
      ++samples;
    }
  }
  if (samples < kLeastSamples) return;
  std::size_t bin = 0;
  for (double within = 0.0; bin < fit.histogram.size(); ++bin) {
    within += fit.histogram[bin];
    if (within >= kOneSigma * samples) break;
  }
  const float spread_per_m = (static_cast<float>(bin) + 0.5F) / bins_per_m;
  const float misfit2 = spread_per_m * spread_per_m - static_cast<float>(noise2 / samples);
  const float now = std::clamp(std::sqrt(std::max(misfit2, 0.0F)), kLeast_per_m, kMost_per_m);
  fit.misfit_per_m = now > fit.misfit_per_m ? now : fit.misfit_per_m + kShrink * (now - fit.misfit_per_m);
}

}  // namespace roomradar
