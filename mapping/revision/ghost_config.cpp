// ghost_config.cpp: checks the settings of ghost removal.
#include "mapping/revision/ghost_config.hpp"

#include <cmath>

#include "mapping/types/system/config_check.hpp"

namespace roomradar {

void require_valid(const GhostConfig& c) {
  const ConfigCheck require{"ghosts"};
  require(c.margin_m > 0.0F && std::isfinite(c.margin_m), "margin_m", c.margin_m, "> 0");
  require(c.margin_per_m >= 0.0F && std::isfinite(c.margin_per_m), "margin_per_m", c.margin_per_m, ">= 0");
  require(c.margin_voxels >= 0.0F && std::isfinite(c.margin_voxels), "margin_voxels", c.margin_voxels,
          ">= 0");
  require(c.margin_sigmas >= 0.0F && std::isfinite(c.margin_sigmas), "margin_sigmas", c.margin_sigmas,
          ">= 0");
  require(c.window_radius_m >= 0.0F && c.window_radius_m <= 1.0F, "window_radius_m", c.window_radius_m,
          "in 0..1 m");
  require(c.min_measured_share >= 0.0F && c.min_measured_share <= 1.0F, "min_measured_share",
          c.min_measured_share, "in 0..1");
  require(c.min_through >= 1, "min_through", c.min_through, "1 or more");
  require(c.min_through_share >= 0.0F && c.min_through_share <= 1.0F, "min_through_share",
          c.min_through_share, "in 0..1");
  require(c.min_extent_m >= 0.0F && std::isfinite(c.min_extent_m), "min_extent_m", c.min_extent_m, ">= 0");
  require(c.max_looks >= 1 && c.max_looks <= 60'000, "max_looks", c.max_looks, "in 1..60000");
}

std::int64_t look_stride(std::int64_t frames, const GhostConfig& config) {
  return 1 + (frames - 1) / config.max_looks;
}

}  // namespace roomradar
