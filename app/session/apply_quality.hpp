// apply_quality.hpp: applies quality settings to a session's configuration.
#pragma once
#include "app/quality/quality.hpp"
#include "app/session/session_config.hpp"

namespace roomradar {

/// Sets only the fields of `config` that depend on the quality. A default-constructed quality leaves a
/// default-constructed config unchanged.
void apply(const RunQuality& quality, SessionConfig& config);

}  // namespace roomradar
