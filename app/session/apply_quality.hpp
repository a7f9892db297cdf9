// apply_quality.hpp: applies a run quality to a session's configuration.
#pragma once
#include "app/quality/quality.hpp"
#include "app/session/session_config.hpp"

namespace roomradar {

/// Sets only the fields that depend on the quality. A default quality leaves a default config unchanged.
void apply(const RunQuality& quality, SessionConfig& config);

}  // namespace roomradar
