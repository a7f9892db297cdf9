// apply_scan_quality.cpp: maps the fields of options and scan quality to the prescan's config.
#include "app/cli/apply_scan_quality.hpp"

namespace roomradar {

void apply(const ScanQuality& quality, PrescanConfig& config) {
  config.resolution_m = quality.resolution_m;
  config.surface.max_deviation_m = static_cast<float>(quality.deviation_m);
  config.odometry.view.finest_width_px = quality.tracking_px;
  config.fuse_every = quality.fuse_every;
}

PrescanConfig prescan_config_of(const PrescanOptions& options) {
  constexpr double kMB = 1e6;
  PrescanConfig config;
  apply(options.quality, config);
  config.poses = options.poses;
  config.up = options.up;
  config.hold_out = options.hold_out;
  config.bake_texture = options.texture;
  config.max_memory_bytes = static_cast<std::size_t>(kMB * options.max_memory_mb);
  // Recorded poses may disagree with the depth by more than the threshold that tells a ghost from a wall;
  // ghost removal would then erase walls.
  config.remove_ghosts = options.poses == PoseOrigin::kTracked;
  return config;
}

}  // namespace roomradar
