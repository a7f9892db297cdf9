// held_out.hpp: frames that were tracked but not fused judge the mesh that the others made.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/types/frame_source.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

struct HeldOutScore {
  std::int64_t frames = 0;  ///< held out, with a pose
  std::int64_t pixels = 0;  ///< compared: each 4th in both directions that measured 0 < depth <= 4 m
  double cover = 0.0;       ///< part of them that the mesh lies behind or before, at any distance
  double median_m = 0.0;    ///< of |mesh - measured| along the optical axis, where covered; to 0.05 mm
  double bias_m = 0.0;      ///< median of mesh - measured, likewise
  double outliers = 0.0;    ///< part of the covered pixels that are off by more than 0.1 m
};

/// Draws the mesh as each held-out frame's camera would have measured it and compares. The source is read
/// again. All figures are 0 where no frame was held out, or none of them has a pose.
///
/// @param hold_out    as PrescanConfig::hold_out, > 0
/// @param trajectory  poses by frame index; frames without one are left out
/// @throws Error if the source cannot be rewound, or no GL context can be had
HeldOutScore score_held_out(FrameSource& source, const Mesh& mesh, const std::vector<TimedPose>& trajectory,
                            std::int64_t hold_out);

}  // namespace roomradar
