// apply_quality.hpp: what a quality means to the parts of a scan and of a run.
#pragma once
#include "app/quality.hpp"
#include "app/session.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// Sets what the quality is about, and nothing else. A default quality makes of a default config the same.
void apply(const ScanQuality& quality, PrescanConfig& config);
void apply(const RunQuality& quality, SessionConfig& config);

}  // namespace roomradar
