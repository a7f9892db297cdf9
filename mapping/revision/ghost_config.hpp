// ghost_config.hpp: when surface of the map counts as a ghost.
#pragma once

namespace roomradar {

struct GhostConfig {
  /// A sample is seen through if the measured depth exceeds the sample's by more than the largest of four
  /// margins. The first two (metres, and standard deviations of depth) cover noise and tracking errors.
  float margin_m = 0.03F;
  float margin_sigmas = 4.0F;
  /// Margin per metre of depth: a pose error of 1.7 degrees shifts a slanted surface this much, and sensors
  /// other than the Kinect are noisier at long range.
  float margin_per_m = 0.03F;
  /// Margin in voxels: samples are up to one voxel in front of or behind the measured surface.
  float margin_voxels = 1.5F;
  /// Radius, at the sample's depth, of the window in which every pixel must see through it. Otherwise small
  /// pose errors would let rays pass the edges of static objects.
  float window_radius_m = 0.03F;
  float min_measured_share = 0.5F;  ///< fraction of the window's pixels that must have depth; the centre
                                    ///< always must
  int min_through = 3;              ///< min frames that see through a ghost's sample
  float min_through_share = 0.1F;   ///< min fraction of these among frames that see it or see through it
  /// A connected group of seen-through samples is a ghost if it covers a square of this edge, at two samples
  /// per voxel face. Smaller groups are tracking errors at the edges of static objects.
  float min_extent_m = 0.15F;
  int max_looks = 170;  ///< max frames used, spread over the recording
};

/// Throws Error naming field, value and rule if a setting is out of range.
void require_valid(const GhostConfig& config);

}  // namespace roomradar
