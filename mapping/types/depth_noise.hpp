// depth_noise.hpp: noise model of Kinect v1 depth.
#pragma once
#include <algorithm>
#include <cmath>

namespace roomradar {

/// Returns the standard deviation (m) of a Kinect v1 depth measurement along the optical axis: sigma(z) =
/// 0.0012 + 0.0019 (z - 0.4)^2, constant below 0.4 m. Valid for surfaces seen at up to 60 degrees from the
/// normal. Source: Nguyen, Izadi, Lovell, Modeling Kinect Sensor Noise for Improved 3D Reconstruction and
/// Tracking, 3DIMPVT 2012, equation (3) without the angular term.
inline float depth_sigma_m(float depth_m) {
  const float beyond_m = std::max(depth_m - 0.4F, 0.0F);
  return 0.0012F + 0.0019F * beyond_m * beyond_m;
}

/// Returns the depth, m, of at least 0.4 m, at which depth_sigma_m() is sigma_m.
inline float depth_of_sigma_m(float sigma_m) {
  return 0.4F + std::sqrt(std::max(sigma_m - 0.0012F, 0.0F) / 0.0019F);
}

/// Returns depth_sigma_m(depth_m) plus the term for the angle theta between viewing ray and surface normal.
/// sigma(z, theta) = sigma(z) + 0.0001 / sqrt(z) * theta^2 / (pi/2 - theta)^2. The term matters beyond 60
/// degrees. theta is clamped to 85 degrees, and z in the added term to at least 0.1 m.
inline float depth_sigma_m(float depth_m, float incidence_rad) {
  const float theta = std::clamp(incidence_rad, 0.0F, 1.4835F);
  const float from_grazing = 1.5707963F - theta;
  return depth_sigma_m(depth_m) +
         0.0001F / std::sqrt(std::max(depth_m, 0.1F)) * theta * theta / (from_grazing * from_grazing);
}

}  // namespace roomradar
