// apply_scan_quality.cpp: maps the fields of a scan quality to the prescan's config.
#include "app/cli/apply_scan_quality.hpp"

namespace roomradar {

void apply(const ScanQuality& quality, PrescanConfig& config) {
  config.resolution_m = quality.resolution_m;
  config.surface.max_deviation_m = static_cast<float>(quality.deviation_m);
  config.odometry.view.finest_width_px = quality.tracking_px;
  config.fuse_every = quality.fuse_every;
}

}  // namespace roomradar
