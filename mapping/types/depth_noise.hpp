// depth_noise.hpp: noise model of a depth sensor.
#pragma once
#include <algorithm>
#include <cmath>

namespace roomradar {

/// Standard deviation of a depth measurement along the optical axis: sigma(z) = base + linear z + quadratic
/// max(z - from, 0)^2, m. At large angles of incidence a term is added, see depth_sigma_m(). The defaults are
/// those of a Kinect v1. Source: Nguyen, Izadi, Lovell, Modeling Kinect Sensor Noise for Improved 3D
/// Reconstruction and Tracking, 3DIMPVT 2012, equation (3).
struct DepthNoise {
  float base_m = 0.0012F;
  float linear = 0.0F;              ///< m per m of depth
  float quadratic_per_m = 0.0019F;  ///< 1/m; the growth with depth of a triangulating sensor
  float from_m = 0.4F;
  float grazing = 0.0001F;  ///< factor of the term for the angle of incidence, m^1.5
  friend bool operator==(const DepthNoise&, const DepthNoise&) = default;
};

/// Returns true if all parameters are in their ranges. The standard deviation is then finite and > 0 at every
/// depth, and does not decrease with depth.
inline bool is_valid(const DepthNoise& noise) {
  constexpr float kMost = 1.0F;  // m, or m per m
  const auto is_within = [](float value, float most) { return value >= 0.0F && value <= most; };
  return noise.base_m > 0.0F && is_within(noise.base_m, kMost) && is_within(noise.linear, kMost) &&
         is_within(noise.quadratic_per_m, kMost) && is_within(noise.from_m, 10.0F) &&
         is_within(noise.grazing, kMost);
}

/// Returns the standard deviation, m, at a depth, for surfaces seen at up to 60 degrees from their normal.
inline float depth_sigma_m(const DepthNoise& noise, float depth_m) {
  const float beyond_m = std::max(depth_m - noise.from_m, 0.0F);
  return noise.base_m + noise.quadratic_per_m * beyond_m * beyond_m + noise.linear * depth_m;
}

/// Returns depth_sigma_m() of each element of a vector of floats, such as Float8.
template <typename Floats>
Floats depth_sigmas_m(const DepthNoise& noise, const Floats& depth_m) {
  const Floats beyond_m = max(depth_m - noise.from_m, 0.0F);
  return beyond_m * beyond_m * noise.quadratic_per_m + noise.base_m + depth_m * noise.linear;
}

/// Standard deviation, m, of a measurement of weight 1 in a map: that of a Kinect v1 at 1 m.
inline const float kUnitWeightSigma_m = depth_sigma_m(DepthNoise{}, 1.0F);

/// Inverse of depth_sigma_m(): returns the smallest depth, m, whose standard deviation is at least sigma_m.
/// Searches from DepthNoise::from_m upwards. Returns infinity if there is no such depth.
inline float depth_of_sigma_m(const DepthNoise& noise, float sigma_m) {
  const float rest_m = std::max(sigma_m - noise.base_m - noise.linear * noise.from_m, 0.0F);
  if (rest_m == 0.0F) return noise.from_m;
  if (noise.quadratic_per_m <= 0.0F) return noise.from_m + rest_m / noise.linear;
  if (noise.linear == 0.0F) return noise.from_m + std::sqrt(rest_m / noise.quadratic_per_m);
  return noise.from_m +
         (std::sqrt(noise.linear * noise.linear + 4.0F * noise.quadratic_per_m * rest_m) - noise.linear) /
             (2.0F * noise.quadratic_per_m);
}

/// Returns depth_sigma_m(noise, depth_m) plus the term for the angle theta between viewing ray and surface
/// normal: grazing / sqrt(z) * theta^2 / (pi/2 - theta)^2. The term matters beyond 60 degrees. theta is
/// clamped to 85 degrees, and z in the added term to at least 0.1 m.
inline float depth_sigma_m(const DepthNoise& noise, float depth_m, float incidence_rad) {
  const float theta = std::clamp(incidence_rad, 0.0F, 1.4835F);
  const float from_grazing = 1.5707963F - theta;
  return depth_sigma_m(noise, depth_m) +
         noise.grazing / std::sqrt(std::max(depth_m, 0.1F)) * theta * theta / (from_grazing * from_grazing);
}

/// Returns a lower bound of the relative standard deviation depth_sigma_m(z) / z over all depths z > 0. The
/// bound is at most about 1 % below the minimum.
inline float least_relative_sigma(const DepthNoise& noise) {
  // Without a quadratic part, the relative deviation falls towards `linear`. Otherwise its minimum is where
  // the derivative of base / z + quadratic (z - from)^2 / z is 0.
  if (noise.quadratic_per_m <= 0.0F) return noise.linear;
  const float z = std::sqrt(noise.base_m / noise.quadratic_per_m + noise.from_m * noise.from_m);
  return 0.99F * depth_sigma_m(noise, z) / z;
}

}  // namespace roomradar
