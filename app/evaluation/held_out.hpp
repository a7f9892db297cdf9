// held_out.hpp: scores a mesh by frames that were tracked but not fused into it.
#pragma once
#include <cstdint>
#include <vector>

#include "mapping/types/frame_source.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

struct HeldOutScore {
  std::int64_t frames = 0;  ///< held-out frames with a pose
  std::int64_t pixels = 0;  ///< pixels compared: every 4th in both directions with 0 < depth <= 4 m
  double cover = 0.0;       ///< fraction of these pixels that show the mesh, at any depth
  double median_m = 0.0;    ///< median |mesh - measured| depth over covered pixels; resolution 0.05 mm
  double bias_m = 0.0;      ///< median of mesh - measured; same pixels and resolution
  double outliers = 0.0;    ///< fraction of covered pixels that differ by more than 0.1 m
};

/// Renders the mesh's depth for each held-out frame's camera and compares it with the measured depth. Reads
/// the source again. All results are 0 if no held-out frame has a pose.
///
/// @param hold_out    as PrescanConfig::hold_out, > 0
/// @param trajectory  poses by frame index; frames without a pose are skipped
/// @throws Error if the source cannot be rewound or no GL context is available
HeldOutScore score_held_out(FrameSource& source, const Mesh& mesh, const std::vector<TimedPose>& trajectory,
                            std::int64_t hold_out);

}  // namespace roomradar
