// apply_quality.hpp: applies quality settings to a session: when, and to which fields of its configuration.
// Computes a frame's load.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>

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

/// A change takes effect when the next frame reaches the change's processing stage (FramePart: localisation,
/// mesh, physics or picture).
class QualitySchedule {
 public:
  /// Schedules a change for a stage. Replaces an earlier change scheduled for the same stage.
  void set(FramePart part, const RunQuality& quality) { due_[index_of(part)] = quality; }
  /// Returns and removes the change scheduled for a stage.
  std::optional<RunQuality> take(FramePart part) { return std::exchange(due_[index_of(part)], std::nullopt); }
  /// Calls apply(quality) for each scheduled change, in the order of FramePart, and removes the changes.
  template <typename Apply>
  void take_all(const Apply& apply) {
    for (std::optional<RunQuality>& due : due_)
      if (due) apply(*std::exchange(due, std::nullopt));
  }

 private:
  std::array<std::optional<RunQuality>, kFrameParts> due_;
};

}  // namespace roomradar
