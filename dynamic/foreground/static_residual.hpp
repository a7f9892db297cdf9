// static_residual.hpp: residual between the static model and the live depth where nothing moved.
#pragma once
#include <array>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Drift of the map, a pose error and distorted sensor depth are all errors of inverse depth that hardly
/// change with depth. For a Kinect recording against its own map, the 1 sigma error is 0.003 / m from 0.9 m
/// to 3.5 m, one step of the sensor's disparity. Against an exact model it is 0.0005 / m.
inline constexpr float kUsualMisfit_per_m = 0.003F;

struct StaticResidual {
  float misfit_per_m = kUsualMisfit_per_m;  ///< 1 sigma of inverse depth, without sensor noise
  std::array<int, 256> histogram{};
};

/// Updates the misfit: at once where it grows, over some frames where it shrinks; between 0.0006 and 0.007
/// per metre. Pixels that differ by more than 0.03 / m count as dynamic, not as misfit.
void follow_misfit(const DepthImage& depth_m, const DepthImage& expected_m, StaticResidual& fit);

}  // namespace roomradar
