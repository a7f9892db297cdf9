// apply_scan_quality.hpp: sets a prescan's configuration by a scan quality.
#pragma once
#include "app/quality/quality.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Sets the fields that the quality decides, and no others. A default quality leaves a default config
/// unchanged.
void apply(const ScanQuality& quality, PrescanConfig& config);

}  // namespace roomradar
