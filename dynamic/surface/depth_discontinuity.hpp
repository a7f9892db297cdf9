// depth_discontinuity.hpp: decides whether two neighbouring pixels are on one surface or at a depth
// discontinuity.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Two pixels are on one surface if their depths differ by at most the noise of both plus the depth change of
/// the steepest plane.
class DepthDiscontinuity {
 public:
  /// @param noise          of the sensor
  /// @param sigmas         max noise of the difference, in standard deviations
  /// @param incidence_deg  angle between view ray and normal of the steepest plane that counts as one surface
  /// @param apart_px       distance of the two pixels along a row or a column
  DepthDiscontinuity(const DepthNoise& noise, float sigmas, float incidence_deg, float apart_px,
                     const Intrinsics& camera)
      : noise_(noise),
        sigmas_(sigmas * std::numbers::sqrt2_v<float>),
        slope_(std::tan(incidence_deg * std::numbers::pi_v<float> / 180.0F) * apart_px /
               static_cast<float>(std::min(camera.fx_px, camera.fy_px))),
        least_jump_(sigmas_ * least_relative_sigma(noise) + slope_) {}

  /// Returns true for two pixels on one surface. The pixels are apart_px apart along a row or a column; for
  /// is_one_surface_diagonally(), along both. Depths are in metres and > 0.
  [[nodiscard]] bool is_one_surface(float a_m, float b_m) const { return is_one_surface(a_m, b_m, slope_); }
  [[nodiscard]] bool is_one_surface_diagonally(float a_m, float b_m) const {
    return is_one_surface(a_m, b_m, slope_ * std::numbers::sqrt2_v<float>);
  }
  /// Returns the result of is_one_surface(), for inverse depths, 1/m.
  [[nodiscard]] bool is_one_surface_inverse(float a, float b) const {
    const float nearest = std::max(a, b), farthest = std::min(a, b);
    if (nearest - farthest <= least_jump() * farthest) return true;
    return nearest - farthest <=
           (sigmas_ * depth_sigma_m(noise_, 1.0F / nearest) * nearest + slope_) * farthest;
  }
  /// Returns the greatest relative difference of inverse depths that counts as one surface at any depth.
  [[nodiscard]] float least_jump() const { return least_jump_; }

 private:
  [[nodiscard]] bool is_one_surface(float a_m, float b_m, float slope) const {
    const float z = std::min(a_m, b_m);
    return std::abs(a_m - b_m) <= sigmas_ * depth_sigma_m(noise_, z) + slope * z;
  }
  DepthNoise noise_;
  float sigmas_, slope_, least_jump_;
};

}  // namespace roomradar
