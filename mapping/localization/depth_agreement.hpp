// depth_agreement.hpp: agreement of a depth image with the depth that the map's model predicts at a pose.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Pixel counts, over every fourth pixel of every fourth row of a depth image.
struct DepthAgreement {
  int valid = 0;  ///< number of pixels with a measurement
  int both = 0;   ///< number of measured pixels where the model has a surface, too
  /// Number of pixels in `both` whose two depths agree within the noise and the distortion of the map.
  int alike = 0;
  /// Number of pixels in `both` whose measured depth is clearly beyond the model's surface.
  int farther = 0;

  [[nodiscard]] double alike_part() const { return both > 0 ? static_cast<double>(alike) / both : 0.0; }
  [[nodiscard]] double farther_part() const { return both > 0 ? static_cast<double>(farther) / both : 0.0; }
  /// Returns the agreement, at most 1. Pixels beyond the model's surface count against the pose twice,
  /// because the camera cannot look through a wall; only a removed object explains them. Nearer pixels count
  /// once, because an object may have come into the room.
  [[nodiscard]] double score() const { return valid > 0 ? (alike - 2.0 * farther) / valid : 0.0; }
};

/// Counts the pixels of the measured and the expected image. Both images must have the same size.
DepthAgreement depth_agreement_of(const DepthImage& depth_m, const DepthImage& expected_m);

}  // namespace roomradar
