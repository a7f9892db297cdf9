// apply_scan_quality.hpp: applies quality settings to a prescan's configuration.
#pragma once
#include "app/quality/quality.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Sets only the fields of `config` that depend on the quality. A default-constructed quality leaves a
/// default-constructed config unchanged.
void apply(const ScanQuality& quality, PrescanConfig& config);

}  // namespace roomradar
