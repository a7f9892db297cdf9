// apply_scan_quality.hpp: converts the options of a prescan to its configuration.
#pragma once
#include "app/cli/options/prescan_options.hpp"
#include "app/quality/quality.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Sets only the fields of `config` that depend on the quality. A default-constructed quality leaves a
/// default-constructed config unchanged.
void apply(const ScanQuality& quality, PrescanConfig& config);

/// Configures a prescan that extends a map. Copies the map's resolution and the max deviation of its
/// simplified mesh to `config`. A deviation that the user has given (is_deviation_asked_for) takes precedence
/// and is stored in the map.
void keep_settings_of(SavedMap& map, bool is_deviation_asked_for, PrescanConfig& config);

/// Returns the configuration of a prescan: default values, changed by the given options.
PrescanConfig prescan_config_of(const PrescanOptions& options);

}  // namespace roomradar
