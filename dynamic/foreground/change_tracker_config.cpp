// change_tracker_config.cpp: checks the settings of the change tracker.
#include "dynamic/foreground/change_tracker_config.hpp"

#include <cmath>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {

void require_valid(const ChangeTrackerConfig& config) {
  const ConfigCheck require{"change_tracker"};
  const auto part = [](float value) { return value >= 0.0F && value <= 1.0F; };
  require(config.spacing_m >= 0.002F && config.spacing_m <= 1.0F, "spacing_m", config.spacing_m,
          "in 0.002..1");
  require(config.agree_sigmas > 0.0F && config.agree_sigmas < 1e3F, "agree_sigmas", config.agree_sigmas,
          "in 0..1000");
  require(config.pose_sigma_m >= 0.0F && config.pose_sigma_m < 1.0F, "pose_sigma_m", config.pose_sigma_m,
          "in 0..1");
  require(config.pose_sigma_per_m >= 0.0F && config.pose_sigma_per_m < 1.0F, "pose_sigma_per_m",
          config.pose_sigma_per_m, "in 0..1");
  require(config.own_reach_m >= 0.0F && std::isfinite(config.own_reach_m), "own_reach_m", config.own_reach_m,
          ">= 0");
  require(config.link_m >= config.spacing_m && config.link_m <= 1.0F, "link_m", config.link_m,
          "at least spacing_m, and at most 1");
  require(config.min_cells >= 1, "min_cells", config.min_cells, ">= 1");
  require(part(config.min_steady_fraction), "min_steady_fraction", config.min_steady_fraction, "in 0..1");
  require(part(config.min_core_fraction), "min_core_fraction", config.min_core_fraction, "in 0..1");
  require(part(config.min_seen_fraction), "min_seen_fraction", config.min_seen_fraction, "in 0..1");
  require(part(config.min_known_fraction), "min_known_fraction", config.min_known_fraction, "in 0..1");
  require(config.forget_after_s > 0.0F, "forget_after_s", config.forget_after_s, "> 0");
  require(config.max_points >= 1 && config.max_points <= 10'000'000, "max_points",
          static_cast<double>(config.max_points), "in 1..10000000");
}

}  // namespace roomradar
