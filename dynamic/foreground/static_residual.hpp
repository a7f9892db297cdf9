// static_residual.hpp: residual between the static model and the live depth where nothing moved.
#pragma once
#include <array>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Typical 1 sigma difference of inverse depth between model and live depth. Drift of the map, pose errors
/// and sensor distortion cause errors of inverse depth that hardly change with depth. A Kinect recording
/// against its own map has 0.003 / m from 0.9 m to 3.5 m, one step of the sensor's disparity; against an
/// exact model it has 0.0005 / m.
inline constexpr float kUsualMisfit_per_m = 0.003F;

struct StaticResidual {
  /// 1 sigma of live minus expected inverse depth, without sensor noise.
  float misfit_per_m = kUsualMisfit_per_m;
  std::array<int, 256> histogram{};  ///< scratch: differences from 0 to 0.03 / m
};

/// Updates the misfit from one frame; it grows at once, shrinks over some frames, and stays within 0.0006 to
/// 0.007 per metre. Pixels that differ by 0.03 / m or more are left out as dynamic.
void follow_misfit(const DepthImage& depth_m, const DepthImage& expected_m, StaticResidual& fit);

}  // namespace roomradar
