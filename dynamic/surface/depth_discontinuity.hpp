// jump_rule.hpp: are two neighbouring pixels on one surface, or is there a jump in depth between them?
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping/types/depth_noise.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Two pixels are one surface where their depths differ by no more than noise of both and a plane's slope
/// explain.
class JumpRule {
 public:
  /// @param sigmas         of the noise of a difference
  /// @param incidence_deg  between the view ray and the normal of the steepest plane that is still one
  /// surface
  /// @param apart_px       between the two pixels, along a row or a column
  JumpRule(float sigmas, float incidence_deg, float apart_px, const Intrinsics& camera)
      : sigmas_(sigmas * std::numbers::sqrt2_v<float>),
        slope_(std::tan(incidence_deg * std::numbers::pi_v<float> / 180.0F) * apart_px /
               static_cast<float>(std::min(camera.fx_px, camera.fy_px))) {}

  /// Side by side, or across the diagonal. Depths in metres, > 0.
  [[nodiscard]] bool joins(float a_m, float b_m) const { return joins(a_m, b_m, slope_); }
  [[nodiscard]] bool joins_diagonally(float a_m, float b_m) const {
    return joins(a_m, b_m, slope_ * std::numbers::sqrt2_v<float>);
  }
  /// Side by side, of inverse depths, 1/m.
  [[nodiscard]] bool joins_inverse(float a, float b) const {
    const float nearest = std::max(a, b), farthest = std::min(a, b);
    if (nearest - farthest <= least_jump() * farthest) return true;
    return nearest - farthest <= (sigmas_ * depth_sigma_m(1.0F / nearest) * nearest + slope_) * farthest;
  }
  /// Inverse depths that differ by no more than this part of theirs are one surface at any depth.
  [[nodiscard]] float least_jump() const {
    constexpr float kLeastNoise = 0.0018F;  // of depth_sigma_m(z) / z, at 0.9 m
    return sigmas_ * kLeastNoise + slope_;
  }

 private:
  [[nodiscard]] bool joins(float a_m, float b_m, float slope) const {
    const float z = std::min(a_m, b_m);
    return std::abs(a_m - b_m) <= sigmas_ * depth_sigma_m(z) + slope * z;
  }
  float sigmas_, slope_;
};

}  // namespace roomradar
