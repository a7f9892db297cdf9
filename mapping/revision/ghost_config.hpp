// ghost_config.hpp: thresholds above which a surface of the map counts as a ghost, left by an object that
// moved away.
#pragma once

namespace roomradar {

struct GhostConfig {
  /// A sample is seen through if the measured depth exceeds the sample's by more than the largest of four
  /// margins. The first two (metres, and standard deviations of depth) cover noise and tracking errors.
  float margin_m = 0.03F;
  float margin_sigmas = 4.0F;
  /// Margin per metre of depth, m. Covers a pose error of 1.7 degrees on a slanted surface, and sensors that
  /// are noisier than the Kinect at long range.
  float margin_per_m = 0.03F;
  /// Margin in voxels: samples are up to one voxel in front of or behind the measured surface.
  float margin_voxels = 1.5F;
  /// Radius of a window around the sample's pixel, m at the sample's depth. A frame sees through the sample
  /// only if all measured pixels of the window do; otherwise, with small pose errors, rays that pass the edge
  /// of a static object would count.
  float window_radius_m = 0.03F;
  /// Min fraction of the window's pixels with depth; the centre always needs depth.
  float min_measured_share = 0.5F;
  int min_through = 3;  ///< min number of frames that must see through a ghost's sample
  /// Min fraction of frames that see through a ghost's sample, among all frames that measure it or see
  /// through it.
  float min_through_share = 0.1F;
  /// A connected group of seen-through samples is a ghost if it has enough samples for a square of this edge,
  /// at two samples per voxel of area. Smaller groups are tracking errors at the edges of static objects.
  float min_extent_m = 0.15F;
  int max_looks = 170;  ///< max number of frames used, evenly spaced over the recording
};

/// Throws Error (naming the field, its value and the rule) if a setting is out of range.
void require_valid(const GhostConfig& config);

}  // namespace roomradar
