// fusion_config.hpp: what governs how a depth frame changes the static map.
#pragma once

namespace roomradar {

struct FusionConfig {
  float max_range_m = 5.0F;  ///< surfaces beyond are too noisy (sigma 4 cm); rays clear up to here
  /// Signed distance is kept this far from a surface (more blurs it where poses disagree, less leaves holes),
  /// or as far as truncation_sigmas says.
  float truncation_voxels = 2.0F;
  float truncation_sigmas = 2.5F;  ///< standard deviations of the measured depth; the greater of both holds
  float max_weight = 64.0F;        ///< cap of a sample's weight, so that what changed can be forgotten
  /// A frame that clearly sees through a sample counts as so many that measured it: what is static is never
  /// seen through, what moved on was measured often.
  float seen_through_gain = 8.0F;
  float hit_log_odds = 0.847298F;    ///< OctoMap's p = 0.7 for a voxel that a ray ends in
  float miss_log_odds = -0.405465F;  ///< OctoMap's p = 0.4 for one that a ray crosses
  float min_log_odds = -2.0F;        ///< OctoMap's clamping, p = 0.12
  float max_log_odds = 3.5F;         ///< p = 0.97
};

/// Throws Error naming field, value and rule.
void require_valid(const FusionConfig& config);

}  // namespace roomradar
