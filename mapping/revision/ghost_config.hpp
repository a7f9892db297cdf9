// ghost_config.hpp: thresholds at which a surface of the map counts as a ghost (surface of an object that
// moved away during the scan).
#pragma once
#include <cstdint>

namespace roomradar {

struct GhostConfig {
  /// A frame sees through a sample (a voxel with a signed distance) if the frame's depth there exceeds the
  /// sample's depth by more than the largest of the four margins below. margin_m (metres) and margin_sigmas
  /// (standard deviations of depth) cover noise and tracking errors.
  float margin_m = 0.03F;
  float margin_sigmas = 4.0F;
  /// Margin per metre of depth. Covers a pose error of 1.7 degrees on a slanted surface, and sensors that are
  /// noisier than the Kinect at long range.
  float margin_per_m = 0.03F;
  /// Margin in voxels: samples are up to one voxel in front of or behind the measured surface.
  float margin_voxels = 1.5F;
  /// Radius of a window around the sample's pixel, in m at the sample's depth. A frame sees through the
  /// sample only if all measured pixels of the window do. With a single pixel, small pose errors would make
  /// rays past the edge of a static object count as well.
  float window_radius_m = 0.03F;
  /// Min fraction of the window's pixels that must have depth. The centre pixel must always have depth.
  float min_measured_share = 0.5F;
  /// Min frames that see through a sample; one suffices for samples connected to such samples.
  int min_through = 3;
  /// Min fraction of frames that see through a ghost's sample, relative to all frames that measure it or see
  /// through it.
  float min_through_share = 0.1F;
  /// Min size of a ghost, as the edge of a square, m. A connected component of samples that frames see
  /// through is a ghost only if it has at least as many samples as the square. The square has two samples per
  /// voxel of area. Smaller components are tracking errors at the edges of static objects.
  float min_extent_m = 0.15F;
  int max_looks = 170;  ///< max number of frames used, evenly spaced over the recording
};

/// Throws Error (naming the field, its value and the rule) if a setting is out of range.
void require_valid(const GhostConfig& config);

/// Returns n such that every n-th of `frames` frames is used; 1: all.
std::int64_t look_stride(std::int64_t frames, const GhostConfig& config);

}  // namespace roomradar
