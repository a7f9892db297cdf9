// fusion_config.hpp: settings for fusing depth frames into the static map.
#pragma once

namespace roomradar {

struct FusionConfig {
  float max_range_m = 5.0F;  ///< max depth fused as surface; beyond, noise is too high (sigma 4 cm); rays
                             ///< clear up to here
  /// Half-width of the truncation band, voxels; the larger of this and truncation_sigmas applies. A wider
  /// band blurs the surface if poses disagree, a narrower one leaves holes.
  float truncation_voxels = 2.0F;
  float truncation_sigmas = 2.5F;  ///< half-width of the truncation band, standard deviations of depth
  float max_weight = 64.0F;        ///< max weight of a sample, which lets it adapt to changes
  /// Weight of a frame that clearly sees through a sample, relative to a frame that measures it. Above 1:
  /// static surfaces are never seen through, and departed objects were measured often.
  float seen_through_gain = 8.0F;
  float hit_log_odds = 0.847298F;    ///< OctoMap's p = 0.7, for a voxel containing a ray endpoint
  float miss_log_odds = -0.405465F;  ///< OctoMap's p = 0.4, for a voxel crossed by a ray
  float min_log_odds = -2.0F;        ///< OctoMap's clamping, p = 0.12
  float max_log_odds = 3.5F;         ///< p = 0.97
};

/// Throws Error naming field, value and rule if a setting is out of range.
void require_valid(const FusionConfig& config);

}  // namespace roomradar
