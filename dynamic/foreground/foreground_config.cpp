// foreground_config.cpp: valid ranges of the foreground's settings.
#include "dynamic/foreground/foreground_config.hpp"

#include <cmath>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {
void require_valid(const ForegroundConfig& config) {
  const ConfigCheck require{"foreground"};
  const auto from_0_to_1 = [](float value) { return value >= 0.0F && value <= 1.0F; };
  require(from_0_to_1(config.model_sigma_m), "model_sigma_m", config.model_sigma_m, "in 0..1");
  require(from_0_to_1(config.pose_sigma_m), "pose_sigma_m", config.pose_sigma_m, "in 0..1");
  require(config.pose_sigma_rad >= 0.0F && config.pose_sigma_rad < 0.1F, "pose_sigma_rad",
          config.pose_sigma_rad, "in 0..0.1");
  require(config.weak_sigmas > 0.0F && config.weak_sigmas < 1e3F, "weak_sigmas", config.weak_sigmas,
          "in 0..1000");
  require(config.strong_sigmas >= config.weak_sigmas && config.strong_sigmas < 1e3F, "strong_sigmas",
          config.strong_sigmas, "at least weak_sigmas, and under 1000");
  require(config.hysteresis > 0.0F && config.hysteresis <= 1.0F, "hysteresis", config.hysteresis,
          "above 0, at most 1");
  require(from_0_to_1(config.edge_error_m), "edge_error_m", config.edge_error_m, "in 0..1");
  require(config.edge_error_rad >= 0.0F && config.edge_error_rad < 0.1F, "edge_error_rad",
          config.edge_error_rad, "in 0..0.1");
  require(from_0_to_1(config.min_strong_fraction), "min_strong_fraction", config.min_strong_fraction,
          "in 0..1");
  require(from_0_to_1(config.min_strong_of_all), "min_strong_of_all", config.min_strong_of_all, "in 0..1");
  require(from_0_to_1(config.min_strong_of_all_revealed), "min_strong_of_all_revealed",
          config.min_strong_of_all_revealed, "in 0..1");
  require(config.weak_reach_px >= 0 && config.weak_reach_px <= 256, "weak_reach_px", config.weak_reach_px,
          "in 0..256");
  require(config.hole_reach_px >= 0 && config.hole_reach_px <= 256, "hole_reach_px", config.hole_reach_px,
          "in 0..256");
  require(config.max_gap_rad >= 0.0F && config.max_gap_rad <= 1.0F, "max_gap_rad", config.max_gap_rad,
          "in 0..1");
  require(config.min_region_px >= 0, "min_region_px", config.min_region_px, ">= 0");
  require(config.min_region_m2 >= 0.0F && std::isfinite(config.min_region_m2), "min_region_m2",
          config.min_region_m2, ">= 0");
}

}  // namespace roomradar
