// stamp_pairing.cpp: pairs each depth image with the nearest colour image, as early as the pair is certain.
#include "app/sources/formats/stamp_pairing.hpp"

#include <algorithm>
#include <cmath>

namespace roomradar {

void StampPairing::add_depth(std::int64_t depth, double stamp_s) { waiting_.push_back({depth, stamp_s}); }

void StampPairing::add_colour(std::int64_t colour, double stamp_s) {
  colours_.push_back({colour, stamp_s});
  if (colours_.size() > config_.colours_kept) colours_.pop_front();
}

std::optional<DepthColourPair> StampPairing::take() {
  if (waiting_.empty()) return std::nullopt;
  const Stamped depth = waiting_.front();
  DepthColourPair pair{.depth = depth.number};
  // Also true for NaN.
  pair.stamp_goes_back = last_depth_s_ ? !(depth.stamp_s > *last_depth_s_) : !std::isfinite(depth.stamp_s);
  if (pair.stamp_goes_back) {
    waiting_.pop_front();
    return pair;
  }

  const auto distance_s = [](const Stamped& colour, const Stamped& depth_image) {
    return std::abs(colour.stamp_s - depth_image.stamp_s);
  };
  const auto next = std::find_if(waiting_.begin() + 1, waiting_.end(),
                                 [&](const Stamped& later) { return later.stamp_s > depth.stamp_s; });
  const Stamped* nearest = nullptr;
  bool has_later = false;
  for (const Stamped& colour : colours_) {
    has_later |= colour.stamp_s >= depth.stamp_s;
    if (next != waiting_.end() && distance_s(colour, *next) < distance_s(colour, depth)) continue;
    if (nearest == nullptr || distance_s(colour, depth) < distance_s(*nearest, depth)) nearest = &colour;
  }
  const bool is_unbeaten = nearest != nullptr && (distance_s(*nearest, depth) <= config_.unbeatable_s ||
                                                  (has_later && nearest->stamp_s <= depth.stamp_s));
  if (!finished_ && waiting_.size() == 1 && !is_unbeaten) return std::nullopt;

  waiting_.pop_front();
  last_depth_s_ = depth.stamp_s;
  if (nearest != nullptr && distance_s(*nearest, depth) <= config_.tolerance_s) {
    pair.colour = nearest->number;
    pair.colour_after_depth_s = nearest->stamp_s - depth.stamp_s;
  }
  std::erase_if(colours_, [&](const Stamped& colour) {
    return colour.number == pair.colour || colour.stamp_s <= depth.stamp_s;
  });
  return pair;
}

}  // namespace roomradar
