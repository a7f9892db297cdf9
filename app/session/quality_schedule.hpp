// quality_schedule.hpp: changes of quality, each due at a part of the next frame.
#pragma once
#include <array>
#include <optional>
#include <utility>

#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"

namespace roomradar {

class QualitySchedule {
 public:
  /// Schedules a change; replaces one that is due at the same part.
  void set(FramePart part, const RunQuality& quality) { due_[index_of(part)] = quality; }
  /// Returns the change that is due at this part, and removes it.
  std::optional<RunQuality> take(FramePart part) { return std::exchange(due_[index_of(part)], std::nullopt); }
  /// Calls apply(quality) with all scheduled changes, in the order of the parts, and removes them.
  template <typename Apply>
  void take_all(const Apply& apply) {
    for (std::optional<RunQuality>& due : due_)
      if (due) apply(*std::exchange(due, std::nullopt));
  }

 private:
  std::array<std::optional<RunQuality>, kFrameParts> due_;
};

}  // namespace roomradar
