// depth_agreement.hpp: agreement of a depth image with the depth expected at a pose.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Pixel counts over every fourth pixel of every fourth row of the depth image.
struct DepthAgreement {
  int valid = 0;    ///< pixels with a measurement
  int both = 0;     ///< valid pixels where the room's model has a surface
  int alike = 0;    ///< pixels of `both` on the same surface, within noise and distortion of the map
  int farther = 0;  ///< pixels of `both` where the camera looks through the model's surface

  [[nodiscard]] double alike_part() const { return both > 0 ? static_cast<double>(alike) / both : 0.0; }
  [[nodiscard]] double farther_part() const { return both > 0 ? static_cast<double>(farther) / both : 0.0; }
  /// Agreement; at most 1, if everything is explained. Nearer pixels may be objects that came into the room.
  /// Farther pixels contradict the pose, though objects can be taken away.
  [[nodiscard]] double score() const { return valid > 0 ? (alike - 2.0 * farther) / valid : 0.0; }
};

/// Both images must have the same size.
DepthAgreement depth_agreement_of(const DepthImage& depth_m, const DepthImage& expected_m);

}  // namespace roomradar
