// evidence.hpp: whether a depth image bears out that the camera stands where it is taken to be.
#pragma once
#include "mapping/types/image.hpp"

namespace roomradar {

/// Counts of pixels of the depth image, every fourth of every fourth row.
struct Evidence {
  int valid = 0;    ///< with a measurement
  int both = 0;     ///< of these, where the room's model has a surface too
  int alike = 0;    ///< of these, the same surface: apart by no more than noise and a distorted map make them
  int farther = 0;  ///< of both, where the camera looks through the model's surface

  [[nodiscard]] double alike_part() const { return both > 0 ? static_cast<double>(alike) / both : 0.0; }
  [[nodiscard]] double farther_part() const { return both > 0 ? static_cast<double>(farther) / both : 0.0; }
  /// From 1, all is explained, down. What is nearer may have come into the room; what is farther speaks
  /// against the pose, though things can be taken away.
  [[nodiscard]] double score() const { return valid > 0 ? (alike - 2.0 * farther) / valid : 0.0; }
};

/// Both images are of one size.
Evidence evidence_of(const DepthImage& depth_m, const DepthImage& expected_m);

}  // namespace roomradar
