// apply_quality.hpp: applies quality settings to a session's configuration, and computes a frame's load.
#pragma once
#include <memory>
#include <span>

#include "app/objects/virtual_object.hpp"
#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"
#include "app/session/session_config.hpp"

namespace roomradar {

/// Sets only the fields of `config` that depend on the quality. A default-constructed quality leaves a
/// default-constructed config unchanged.
void apply(const RunQuality& quality, SessionConfig& config);

/// Returns the load of a frame, for budgets that choose the quality.
/// @param dynamic_fraction  fraction of the last frame's pixels that are dynamic
FrameLoad load_of(std::span<const std::unique_ptr<VirtualObject>> objects, double dynamic_fraction);

}  // namespace roomradar
