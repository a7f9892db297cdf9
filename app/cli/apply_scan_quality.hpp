// apply_scan_quality.hpp: the configuration of a prescan, from its options.
#pragma once
#include "app/cli/options/prescan_options.hpp"
#include "app/quality/quality.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Sets only the fields of `config` that depend on the quality. A default-constructed quality leaves a
/// default-constructed config unchanged.
void apply(const ScanQuality& quality, PrescanConfig& config);

/// Gives a prescan that extends a map the map's resolution and its mesh's deviation. A deviation that was
/// asked for takes precedence, and the map keeps it.
void keep_settings_of(SavedMap& map, bool is_deviation_asked_for, PrescanConfig& config);

/// Returns the configuration of a prescan with these options.
PrescanConfig prescan_config_of(const PrescanOptions& options);

}  // namespace roomradar
