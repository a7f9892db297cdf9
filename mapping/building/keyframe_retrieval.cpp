// keyframe_retrieval.cpp: an index over the features of keyframes.
#include "mapping/building/keyframe_retrieval.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "mapping/building/building_map.hpp"
#include "mapping/localization/place_matching.hpp"

namespace roomradar {
namespace {

/// The features of a submap's keyframes that differ in their view.
struct DistinctKeyframes {
  KeyframeDatabase database;          ///< descriptors only; not indexed
  std::vector<std::size_t> index_of;  ///< by keyframe of `database`: its index in the submap
};

DistinctKeyframes distinct_keyframes(const Submap& submap, double min_step) {
  const auto& keyframes = submap.keyframes.keyframes;
  DistinctKeyframes distinct;
  distinct.index_of = distinct_views(keyframes, min_step);
  for (const std::size_t k : distinct.index_of) {
    const auto& all = keyframes[k].descriptors;
    const auto count = std::min(all.size(), FeatureIndex::kIndexedFeatures);
    distinct.database.keyframes.emplace_back().descriptors.assign(
        all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
  }
  return distinct;
}

}  // namespace

void KeyframeRetrieval::add(const Submap& submap) {
  DistinctKeyframes added = distinct_keyframes(submap, config_.min_step);
  std::map<std::size_t, std::size_t> similar;  // by submap
  for (const MapKeyframe& keyframe : added.database.keyframes) {
    const auto candidates = database_.index.candidates(keyframe.descriptors, config_.candidates, {});
    std::set<std::size_t> submaps;
    for (const std::size_t i :
         most_alike_of(candidates, keyframe, database_, candidates.size(), config_.min_matches))
      submaps.insert(submap_of_[i]);
    for (const std::size_t a : submaps) ++similar[a];
  }
  for (const auto& [a, count] : similar)
    if (count >= config_.min_similar) found_.push_back({a, submaps_, count});
  submap_of_.resize(submap_of_.size() + added.database.keyframes.size(), submaps_++);
  std::move(added.database.keyframes.begin(), added.database.keyframes.end(),
            std::back_inserter(database_.keyframes));
  update_index(database_);
}

std::vector<CandidatePair> KeyframeRetrieval::pairs() const {
  std::vector<CandidatePair> best_first = found_;
  std::stable_sort(
      best_first.begin(), best_first.end(),
      [](const CandidatePair& one, const CandidatePair& other) { return one.similar > other.similar; });
  std::vector<CandidatePair> pairs;
  std::vector<std::size_t> partners(submaps_, 0);
  for (const CandidatePair& pair : best_first) {
    const bool is_kept = std::min(partners[pair.a]++, partners[pair.b]++) < config_.partners;
    if (is_kept) pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(), [](const CandidatePair& one, const CandidatePair& other) {
    return std::pair(one.a, one.b) < std::pair(other.a, other.b);
  });
  return pairs;
}

std::vector<std::pair<std::size_t, std::size_t>> similar_keyframes(const Submap& a, const Submap& b,
                                                                   const SimilarConfig& config) {
  DistinctKeyframes of_a = distinct_keyframes(a, config.min_step);
  const DistinctKeyframes of_b = distinct_keyframes(b, config.min_step);
  update_index(of_a.database);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t j = 0; j < of_b.index_of.size(); ++j) {
    const MapKeyframe& keyframe = of_b.database.keyframes[j];
    const auto candidates = of_a.database.index.candidates(keyframe.descriptors, config.candidates, {});
    for (const std::size_t i :
         most_alike_of(candidates, keyframe, of_a.database, config.per_keyframe, config.min_matches))
      pairs.emplace_back(of_a.index_of[i], of_b.index_of[j]);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace roomradar
