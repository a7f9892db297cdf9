// apply_quality.hpp: sets a session's configuration by a run quality.
#pragma once
#include "app/quality/quality.hpp"
#include "app/session/session.hpp"

namespace roomradar {

/// Sets the fields that the quality decides, and no others. A default quality leaves a default config
/// unchanged.
void apply(const RunQuality& quality, SessionConfig& config);

}  // namespace roomradar
