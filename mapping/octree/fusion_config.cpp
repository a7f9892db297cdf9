// fusion_config.cpp: range checks of the fusion settings.
#include "mapping/octree/fusion_config.hpp"

#include <cmath>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {
void require_valid(const FusionConfig& c) {
  const ConfigCheck require{"fusion"};
  require(c.max_range_m > 0.0F && c.max_range_m <= 100.0F, "max_range_m", c.max_range_m, "in 0..100 m");
  require(c.truncation_voxels >= 1.5F && c.truncation_voxels <= 100.0F, "truncation_voxels",
          c.truncation_voxels, "in 1.5..100, or the surface falls between samples");
  require(c.truncation_sigmas >= 0.0F && c.truncation_sigmas <= 10.0F, "truncation_sigmas",
          c.truncation_sigmas, "in 0..10");
  require(c.max_cell_sigmas >= 0.0F && c.max_cell_sigmas <= 100.0F, "max_cell_sigmas", c.max_cell_sigmas,
          "in 0..100");
  require(c.max_weight > 0.0F && std::isfinite(c.max_weight), "max_weight", c.max_weight, "> 0");
  require(c.seen_through_gain > 0.0F && std::isfinite(c.seen_through_gain), "seen_through_gain",
          c.seen_through_gain, "> 0");
  require(c.hit_log_odds > 0.0F && std::isfinite(c.hit_log_odds), "hit_log_odds", c.hit_log_odds, "> 0");
  require(c.miss_log_odds < 0.0F && std::isfinite(c.miss_log_odds), "miss_log_odds", c.miss_log_odds, "< 0");
  require(c.min_log_odds < 0.0F && std::isfinite(c.min_log_odds), "min_log_odds", c.min_log_odds, "< 0");
  require(c.threads >= 0, "threads", c.threads, ">= 0");
  require(c.max_log_odds > 0.0F && std::isfinite(c.max_log_odds), "max_log_odds", c.max_log_odds, "> 0");
}

}  // namespace roomradar
