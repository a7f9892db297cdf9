// apply_scan_quality.hpp: applies a scan quality to a prescan's configuration.
#pragma once
#include "app/quality/quality.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Sets only the fields that depend on the quality. A default quality leaves a default configuration
/// unchanged.
void apply(const ScanQuality& quality, PrescanConfig& config);

}  // namespace roomradar
