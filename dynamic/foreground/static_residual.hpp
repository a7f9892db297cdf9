// model_fit.hpp: how well the static model and the live depth agree where nothing moved.
#pragma once
#include <array>

#include "mapping/types/image.hpp"

namespace roomradar {

/// A map that was tracked with some drift, a pose that is off, a sensor whose depth is bent: all of them are
/// errors of inverse depth that hardly change with depth. On a Kinect's recording against its own map they
/// are 0.003 / m (1 sigma) from 0.9 m to 3.5 m, one step of the sensor's disparity; against an exact model
/// 0.0005.
inline constexpr float kUsualMisfit_per_m = 0.003F;

struct ModelFit {
  float misfit_per_m = kUsualMisfit_per_m;  ///< 1 sigma of inverse depth, without the sensor's noise
  std::array<int, 256> histogram{};
};

/// Follows the misfit: at once where it grows, over some frames where it shrinks; between 0.0006 and 0.007
/// per metre. What is off by more than 0.03 / m counts as moved and not as misfit.
void follow_misfit(const DepthImage& depth_m, const DepthImage& expected_m, ModelFit& fit);

}  // namespace roomradar
