// depth_agreement.hpp: measures how well a depth image agrees with the depth that the map predicts at a pose.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Pixel counts over every fourth pixel of every fourth row of a depth image.
struct DepthAgreement {
  int valid = 0;  ///< number of pixels with a measurement
  int both = 0;   ///< number of valid pixels at which the map's model has a surface, too
  /// Number of pixels in `both` whose two inverse depths differ by less than 0.02 / m, or whose depths differ
  /// by less than 6 mm. The tolerance covers sensor noise, voxels and distortion of the map.
  int alike = 0;
  /// Number of pixels in `both` whose measured depth is beyond the model's surface by more than the tolerance
  /// of `alike`.
  int farther = 0;

  [[nodiscard]] double alike_part() const { return both > 0 ? static_cast<double>(alike) / both : 0.0; }
  [[nodiscard]] double farther_part() const { return both > 0 ? static_cast<double>(farther) / both : 0.0; }
  /// Returns the agreement, at most 1. Each pixel beyond the model's surface reduces the score by 2 / valid.
  /// The camera cannot look through a wall, so only a removed object explains such a pixel. Nearer pixels do
  /// not reduce the score, since objects may have been added.
  [[nodiscard]] double score() const { return valid > 0 ? (alike - 2.0 * farther) / valid : 0.0; }
};

/// Compares the measured with the expected depth. Both images must have the same size.
DepthAgreement depth_agreement_of(const DepthImage& depth_m, const DepthImage& expected_m);

}  // namespace roomradar
