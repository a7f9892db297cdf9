// fusion_config.hpp: what governs how a depth frame changes the static map.
#pragma once

namespace roomradar {

struct FusionConfig {
  float max_range_m = 5.0F;  ///< surfaces beyond are too noisy (sigma 4 cm); rays clear up to here
  float truncation_voxels =
      4.0F;  ///< signed distance is kept this far from a surface, at least (3 leave holes),
  float truncation_sigmas = 4.0F;    ///< and this many standard deviations of the measured depth
  float max_weight = 64.0F;          ///< cap of a sample's weight, so that what changed can be forgotten
  float hit_log_odds = 0.847298F;    ///< OctoMap's p = 0.7 for a voxel that a ray ends in
  float miss_log_odds = -0.405465F;  ///< OctoMap's p = 0.4 for one that a ray crosses
  float min_log_odds = -2.0F;        ///< OctoMap's clamping, p = 0.12
  float max_log_odds = 3.5F;         ///< p = 0.97
};

/// Throws Error naming field, value and rule.
void require_valid(const FusionConfig& config);

}  // namespace roomradar
