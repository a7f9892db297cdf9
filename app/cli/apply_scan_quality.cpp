// apply_scan_quality.cpp: maps the fields of options and scan quality to the prescan's config.
#include "app/cli/apply_scan_quality.hpp"

#include "mapping/map/map_info.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {

void apply(const ScanQuality& quality, PrescanConfig& config) {
  config.resolution_m = quality.resolution_m;
  config.surface.max_deviation_m = static_cast<float>(quality.deviation_m);
  config.odometry.view.finest_width_px = quality.tracking_px;
  config.fuse_every = quality.fuse_every;
}

void keep_settings_of(SavedMap& map, bool is_deviation_asked_for, PrescanConfig& config) {
  config.resolution_m = map.octree.load().resolution_m();
  if (!is_deviation_asked_for && map.info.settings.contains(kDeviationSetting))
    config.surface.max_deviation_m = surface_config_of(map.info).max_deviation_m;
  map.info.settings[kDeviationSetting] = format_number(config.surface.max_deviation_m);
}

PrescanConfig prescan_config_of(const PrescanOptions& options) {
  constexpr double kMB = 1e6;
  PrescanConfig config;
  apply(options.quality, config);
  config.poses = options.poses;
  config.up = options.up;
  config.hold_out = options.hold_out;
  config.max_fused_frames = options.max_fused;
  config.bake_texture = options.texture;
  config.max_memory_bytes = static_cast<std::size_t>(kMB * options.max_memory_mb);
  // Recorded poses may disagree with the depth by more than the threshold that tells a ghost from a wall;
  // ghost removal would then erase walls.
  config.remove_ghosts = options.poses != PoseOrigin::kRecorded;
  return config;
}

}  // namespace roomradar
