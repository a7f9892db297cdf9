// keyframe_cache.hpp: least-recently-used cache of keyframes prepared for alignment.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "mapping/alignment/keyframe.hpp"

namespace roomradar {

/// Keyframe prepared for alignment, both as reference and as live view. Its T_world_view is the identity; the
/// pose is in the Keyframe. 4 MB at 320 x 240, including 0.7 MB for the live view.
struct CachedKeyframe {
  TargetView reference;
  SourcePoints live;
};

enum class PreparedParts { kAll, kLive, kReference };  ///< parts to prepare; the other stays empty

std::shared_ptr<const CachedKeyframe> prepare_keyframe(const StoredView& view, const ViewConfig& config,
                                                       PreparedParts parts = PreparedParts::kAll);

/// Caches at most `capacity` keyframes and evicts the least recently used. Entries stay valid for their
/// holders after eviction. Copies share entries, but are otherwise independent. Not thread safe.
class KeyframeCache {
 public:
  explicit KeyframeCache(std::size_t capacity, PreparedParts parts = PreparedParts::kAll)
      : capacity_(capacity), parts_(parts) {}

  /// Returns null if the keyframe is not cached.
  std::shared_ptr<const CachedKeyframe> find(std::size_t keyframe);
  /// Prepares and caches the keyframe if it is not cached.
  std::shared_ptr<const CachedKeyframe> get(std::size_t keyframe, const StoredView& view,
                                            const ViewConfig& config);
  /// Replaces the keyframe's entry, if any.
  void put(std::size_t keyframe, std::shared_ptr<const CachedKeyframe> made);

 private:
  struct Entry {
    std::size_t keyframe;
    std::shared_ptr<const CachedKeyframe> held;
  };
  std::size_t capacity_;
  PreparedParts parts_;
  std::vector<Entry> entries_;  // most recently used last
};

}  // namespace roomradar
