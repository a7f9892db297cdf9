// fusion_config.hpp: settings for fusing depth frames into the static map.
#pragma once
#include "mapping/types/depth_noise.hpp"

namespace roomradar {

struct FusionConfig {
  /// Max depth that is fused as a surface, m. At larger depths the noise is too high (standard deviation 4 cm
  /// or more). Rays to larger depths only mark the space up to max_range_m as free.
  float max_range_m = 5.0F;
  /// Half-width of the truncation band, in edges of the updated cell (a voxel or a coarse cell). The larger
  /// of truncation_voxels and truncation_sigmas applies. A wider band blurs the surface if poses disagree. A
  /// narrower band leaves gaps in it.
  float truncation_voxels = 2.0F;
  float truncation_sigmas = 2.5F;  ///< half-width of the truncation band, in standard deviations of depth
  /// Max edge of a coarse cell, in standard deviations of depth. Finer cells would store the same surface in
  /// more samples, each with more noise. With 1 cm voxels and the default, cells have an edge of 2 cm where
  /// the surface was measured only from beyond 2.1 m. 0: all cells are voxels.
  float max_cell_sigmas = 2.9F;
  float max_weight = 64.0F;  ///< max weight of a sample, so that samples adapt to changes
  /// Weight of a frame that clearly sees through a sample, relative to a frame that measures the sample. The
  /// default is above 1, since no frame sees through a static surface, but many frames may have measured an
  /// object before its removal.
  float seen_through_gain = 8.0F;
  /// Log-odds added to a voxel that contains a ray endpoint. OctoMap's default, p = 0.7.
  float hit_log_odds = 0.847298F;
  /// Log-odds added to a voxel that a ray crosses. OctoMap's default, p = 0.4.
  float miss_log_odds = -0.405465F;
  float min_log_odds = -2.0F;  ///< lower clamping limit; OctoMap's default, p = 0.12
  float max_log_odds = 3.5F;   ///< upper clamping limit; OctoMap's default, p = 0.97
  /// Noise of the depth sensor. StaticMap::fuse() uses that of the frame instead.
  DepthNoise noise = {};
  /// Number of threads that fuse a frame, at most 8; 0: one per core. The map does not depend on it.
  int threads = 0;
};

/// Throws Error (naming the field, its value and the rule) if a setting is out of range.
void require_valid(const FusionConfig& config);

}  // namespace roomradar
