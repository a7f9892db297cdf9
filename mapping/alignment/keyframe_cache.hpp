// warm_keyframes.hpp: the references of the keyframes that were used last; others are made anew when needed.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "mapping/alignment/keyframe.hpp"

namespace roomradar {

/// A keyframe ready to be aligned with others, both ways. Its pose is the keyframe's; 4 MB at 320 x 240, of
/// which 0.7 MB are the live view.
struct WarmKeyframe {
  ReferenceView reference;
  LiveView live;
};

enum class WarmParts { kAll, kLive, kReference };  ///< the other part is empty

std::shared_ptr<const WarmKeyframe> warm(const StoredView& view, const ViewConfig& config,
                                         WarmParts parts = WarmParts::kAll);

/// Holds at most `capacity` of them, and forgets those that were not asked for the longest. What is handed
/// out stays whole after it is forgotten. Copies share what they hold. Not thread safe; copies are apart.
class WarmKeyframes {
 public:
  explicit WarmKeyframes(std::size_t capacity, WarmParts parts = WarmParts::kAll)
      : capacity_(capacity), parts_(parts) {}

  /// Null if it is not held.
  std::shared_ptr<const WarmKeyframe> find(std::size_t keyframe);
  /// Made if it is not held.
  std::shared_ptr<const WarmKeyframe> get(std::size_t keyframe, const StoredView& view,
                                          const ViewConfig& config);
  /// Takes the place of what was held of that keyframe.
  void put(std::size_t keyframe, std::shared_ptr<const WarmKeyframe> made);

 private:
  struct Entry {
    std::size_t keyframe;
    std::shared_ptr<const WarmKeyframe> held;
  };
  std::size_t capacity_;
  WarmParts parts_;
  std::vector<Entry> entries_;  // the one asked for last comes last
};

}  // namespace roomradar
