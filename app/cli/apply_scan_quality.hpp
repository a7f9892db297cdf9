// apply_scan_quality.hpp: the configuration of a prescan, from its options.
#pragma once
#include "app/cli/options/prescan_options.hpp"
#include "app/quality/quality.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Sets only the fields of `config` that depend on the quality. A default-constructed quality leaves a
/// default-constructed config unchanged.
void apply(const ScanQuality& quality, PrescanConfig& config);

/// Configures a prescan that extends a map: sets the map's resolution, and the deviation of the map's mesh. A
/// deviation that the user gave takes precedence and is stored in the map.
void keep_settings_of(SavedMap& map, bool is_deviation_asked_for, PrescanConfig& config);

/// Returns the configuration of a prescan with these options.
PrescanConfig prescan_config_of(const PrescanOptions& options);

}  // namespace roomradar
