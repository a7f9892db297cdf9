// keyframe_cache.cpp: least-recently-used cache of keyframes prepared for alignment.
#include "mapping/alignment/keyframe_cache.hpp"

#include <algorithm>
#include <utility>

namespace roomradar {

std::shared_ptr<CachedKeyframe> prepare_keyframe(const PackedView& view, const ViewConfig& config,
                                                 PreparedParts parts) {
  auto made = std::make_shared<CachedKeyframe>();
  ViewPyramid pyramid;
  restore(unpacked(view), config, pyramid);
  if (parts == PreparedParts::kAll)
    make_target_view(pyramid, Eigen::Isometry3d::Identity(), config, made->reference);
  make_source_points(pyramid, made->live);
  return made;
}

std::shared_ptr<const CachedKeyframe> KeyframeCache::find(std::size_t keyframe) {
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& entry) { return entry.keyframe == keyframe; });
  if (found == entries_.end()) return nullptr;
  std::rotate(found, found + 1, entries_.end());
  return entries_.back().held;
}

std::shared_ptr<const CachedKeyframe> KeyframeCache::get(std::size_t keyframe, const PackedView& view,
                                                         const ViewConfig& config) {
  if (auto held = find(keyframe)) return held;
  put(keyframe, prepare_keyframe(view, config, parts_));
  return entries_.back().held;
}

void KeyframeCache::put(std::size_t keyframe, std::shared_ptr<CachedKeyframe> made) {
  make_room(keyframe);
  entries_.push_back({keyframe, std::move(made)});
}

std::shared_ptr<CachedKeyframe> KeyframeCache::make_room(std::size_t keyframe) {
  auto leaving = std::find_if(entries_.begin(), entries_.end(),
                              [&](const Entry& entry) { return entry.keyframe == keyframe; });
  if (leaving == entries_.end() && entries_.size() >= capacity_) leaving = entries_.begin();
  if (leaving == entries_.end()) return nullptr;
  std::shared_ptr<CachedKeyframe> held = std::move(leaving->held);
  entries_.erase(leaving);
  return held;
}

}  // namespace roomradar
