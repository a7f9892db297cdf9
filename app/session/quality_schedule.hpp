// quality_schedule.hpp: scheduled changes of the quality settings, at most one per processing stage of a
// frame.
#pragma once
#include <array>
#include <optional>
#include <utility>

#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"

namespace roomradar {

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
