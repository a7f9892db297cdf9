// held_out.hpp: scores a mesh by held-out frames, which were tracked but not fused into the mesh.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/types/frame_source.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

struct HeldOutScore {
  std::int64_t frames = 0;  ///< number of held-out frames with a pose
  /// Number of compared pixels: every 4th pixel in both directions, if 0 < depth <= 4 m.
  std::int64_t pixels = 0;
  double cover = 0.0;  ///< fraction of the compared pixels in which the mesh is visible (covered pixels)
  /// Median of |mesh depth - measured depth| over covered pixels; resolution 0.05 mm.
  double median_m = 0.0;
  /// Median of mesh depth - measured depth over covered pixels; resolution 0.05 mm.
  double bias_m = 0.0;
  double outliers = 0.0;  ///< fraction of covered pixels with a difference above 0.1 m
};

/// Renders the mesh's depth for the camera of each held-out frame and compares it with the measured depth.
/// Rewinds and reads the source. All results are 0 if no held-out frame has a pose.
///
/// @param hold_out    > 0, see PrescanConfig::hold_out
/// @param trajectory  poses by frame index; frames without a pose are skipped
/// @throws Error if the source cannot be rewound or no GL context is available
HeldOutScore score_held_out(FrameSource& source, const Mesh& mesh, const std::vector<TimedPose>& trajectory,
                            std::int64_t hold_out);

}  // namespace roomradar
