// apply_quality.cpp: maps the fields of a run quality to the session's config.
#include "app/session/apply_quality.hpp"

#include <algorithm>

namespace roomradar {

void apply(const RunQuality& quality, SessionConfig& config) {
  config.depth_stride = quality.depth_stride;
  config.tracking_px = quality.tracking_px;
  config.verify_every_n_frames = quality.verify_every_n_frames;
  // Pixel limits are defined for unreduced depth images.
  const ForegroundConfig whole;
  ForegroundConfig& foreground = config.scene.foreground;
  foreground.hole_reach_px = whole.hole_reach_px / quality.depth_stride;
  foreground.weak_reach_px = whole.weak_reach_px / quality.depth_stride;
  foreground.min_region_px = std::max(1, whole.min_region_px / (quality.depth_stride * quality.depth_stride));
  const DepthMeshConfig whole_mesh;
  config.scene.mesh.stride_px = std::max(1, whole_mesh.stride_px / quality.depth_stride);
  config.scene.mesh.skirt_gap_px = whole_mesh.skirt_gap_px / quality.depth_stride;
  config.scene.moved.deviation_sigmas = static_cast<float>(quality.mesh_tolerance_sigmas);
  config.fine_mesh = quality.fine_mesh;
  config.radar = {.mode = quality.radar, .resolution_px = quality.radar_px};
  config.physics.max_step_s = quality.physics_step_s;
  config.move_every_n_frames = quality.move_every_n_frames;
  config.object_error_px = quality.object_error_px;
  config.picture.occlusion.edge_reach_px = quality.soft_edges ? OcclusionConfig{}.edge_reach_px : 0;
  config.picture.bridge_gaps = quality.bridge_gaps;
  config.picture.shadow_strength = quality.shadows ? ComposeConfig{}.shadow_strength : 0.0F;
  config.shadow_every_n_frames = quality.shadow_every_n_frames;
  config.picture_every_n_frames = quality.picture_every_n_frames;
}

FrameLoad load_of(std::span<const std::unique_ptr<VirtualObject>> objects, double dynamic_fraction) {
  FrameLoad load{.dynamic_fraction = dynamic_fraction};
  for (const auto& object : objects)
    if (object->in_room) ++(object->body.asleep ? load.resting : load.moving);
  return load;
}

}  // namespace roomradar
