// static_residual.hpp: residual between the static model's depth and the measured depth of static surfaces.
#pragma once
#include <array>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/image.hpp"

namespace roomradar {

/// Typical standard deviation of the difference in inverse depth between model and measurement. Drift of the
/// map, pose errors and sensor distortion cause errors of inverse depth that hardly change with depth. For a
/// Kinect recording and its own map, the value is 0.003 / m (one disparity step of the sensor) from 0.9 m to
/// 3.5 m. For an exact model, it is 0.0005 / m.
inline constexpr float kUsualMisfit_per_m = 0.003F;

struct StaticResidual {
  /// Standard deviation of measured minus expected inverse depth, without sensor noise.
  float misfit_per_m = kUsualMisfit_per_m;
  std::array<int, 256> histogram{};  ///< scratch: differences from 0 to 0.03 / m
};

/// Updates misfit_per_m from one frame. The value rises immediately, falls by 10 % of the difference per
/// frame, and stays within 0.0006 to 0.007 / m. Pixels whose inverse depth differs by 0.03 / m or more are
/// left out as dynamic.
void follow_misfit(const DepthImage& depth_m, const DepthImage& expected_m, const DepthNoise& noise,
                   StaticResidual& fit);

}  // namespace roomradar
