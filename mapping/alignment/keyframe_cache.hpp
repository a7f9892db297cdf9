// keyframe_cache.hpp: least-recently-used cache of keyframes prepared for alignment.
#pragma once
#include <cstddef>
#include <memory>
#include <vector>

#include "mapping/alignment/packed_view.hpp"

namespace roomradar {

/// Keyframe prepared for alignment, as a reference and as a source of points. The pose is in
/// Keyframe::T_world_camera; reference.T_world_view is the identity. Takes 4 MB at 320 x 240 pixels,
/// including 0.7 MB for `live`.
struct CachedKeyframe {
  TargetView reference;
  SourcePoints live;
};

/// Members of a CachedKeyframe to prepare. kLive: only `live`; `reference` stays empty.
enum class PreparedParts { kAll, kLive };

std::shared_ptr<CachedKeyframe> prepare_keyframe(const PackedView& view, const ViewConfig& config,
                                                 PreparedParts parts = PreparedParts::kAll);

/// Caches at most `capacity` keyframes and evicts the least recently used. A returned entry stays valid after
/// its eviction while the caller keeps the pointer. A copy of a cache shares the entries present at the time
/// of copying, and is otherwise independent. Not thread safe.
class KeyframeCache {
 public:
  explicit KeyframeCache(std::size_t capacity, PreparedParts parts = PreparedParts::kAll)
      : capacity_(capacity), parts_(parts) {}

  /// Returns null if the keyframe is not cached.
  std::shared_ptr<const CachedKeyframe> find(std::size_t keyframe);
  /// Returns the keyframe's entry. Prepares and caches the entry if it is not cached.
  std::shared_ptr<const CachedKeyframe> get(std::size_t keyframe, const PackedView& view,
                                            const ViewConfig& config);
  /// Caches `made` as the keyframe's entry; replaces an existing entry.
  void put(std::size_t keyframe, std::shared_ptr<CachedKeyframe> made);
  /// Removes and returns the entry that put() would replace or evict, so that the caller can reuse its
  /// memory. Returns null if put() would remove no entry.
  std::shared_ptr<CachedKeyframe> make_room(std::size_t keyframe);

 private:
  struct Entry {
    std::size_t keyframe;
    std::shared_ptr<CachedKeyframe> held;
  };
  std::size_t capacity_;
  PreparedParts parts_;
  std::vector<Entry> entries_;  // most recently used last
};

}  // namespace roomradar
