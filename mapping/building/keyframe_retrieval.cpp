// keyframe_retrieval.cpp: an index over the features of all keyframes.
#include "mapping/building/keyframe_retrieval.hpp"

#include <algorithm>
#include <map>

#include "mapping/localization/place_matching.hpp"

namespace roomradar {

void KeyframeRetrieval::add(const Submap& submap) {
  const std::size_t b = first_of_.size(), first = database_.keyframes.size();
  std::vector<MapKeyframe> added;
  for (const MapKeyframe& keyframe : submap.keyframes.keyframes) {
    MapKeyframe& kept = added.emplace_back();
    kept.descriptors = keyframe.descriptors;
    kept.descriptors.resize(std::min(kept.descriptors.size(), FeatureIndex::kIndexedFeatures));
    kept.descriptors.shrink_to_fit();
  }
  for (std::size_t j = 0; j < added.size(); ++j) {
    std::map<std::size_t, std::size_t> count_in;  // by submap
    for (const std::size_t i : most_alike(added[j], database_, config_.candidates, config_.min_matches)) {
      const std::size_t a = submap_of_[i];
      if (++count_in[a] <= config_.per_submap) found_.push_back({a, b, i - first_of_[a], j});
    }
  }
  first_of_.push_back(first);
  submap_of_.resize(first + added.size(), b);
  std::move(added.begin(), added.end(), std::back_inserter(database_.keyframes));
  update_index(database_);
}

std::vector<CandidatePair> KeyframeRetrieval::pairs() const {
  std::vector<Found> sorted = found_;
  std::sort(sorted.begin(), sorted.end());
  std::vector<CandidatePair> pairs;
  for (const Found& found : sorted) {
    if (pairs.empty() || pairs.back().a != found.a || pairs.back().b != found.b)
      pairs.push_back({found.a, found.b, {}});
    pairs.back().keyframes.emplace_back(found.keyframe_a, found.keyframe_b);
  }
  std::erase_if(pairs, [&](const CandidatePair& pair) { return pair.keyframes.size() < config_.min_pairs; });
  return pairs;
}

}  // namespace roomradar
