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

/// Returns the pairs that are among the `partners` best of one of their submaps, sorted by a, then b.
std::vector<CandidatePair> best_partners(std::vector<CandidatePair> found, std::size_t submaps,
                                         std::size_t partners) {
  std::stable_sort(found.begin(), found.end(), [](const CandidatePair& one, const CandidatePair& other) {
    return one.similar > other.similar;
  });
  std::vector<CandidatePair> best;
  std::vector<std::size_t> pairs_of(submaps, 0);
  for (const CandidatePair& pair : found) {
    const bool is_kept = std::min(pairs_of[pair.a]++, pairs_of[pair.b]++) < partners;
    if (is_kept) best.push_back(pair);
  }
  std::sort(best.begin(), best.end(), [](const CandidatePair& one, const CandidatePair& other) {
    return std::pair(one.a, one.b) < std::pair(other.a, other.b);
  });
  return best;
}

}  // namespace

void KeyframeRetrieval::add(const Submap& submap) {
  DistinctKeyframes added = distinct_keyframes(submap, config_.min_step);
  submap_of_.resize(submap_of_.size() + added.database.keyframes.size(), submaps_++);
  std::move(added.database.keyframes.begin(), added.database.keyframes.end(),
            std::back_inserter(database_.keyframes));
  update_index(database_);
}

std::vector<CandidatePair> KeyframeRetrieval::find_pairs() {
  database_.index.sort();
  struct Similar {
    std::size_t in_a = 0, in_b = 0;  // keyframes that look similar to one of the other submap
  };
  std::map<std::pair<std::size_t, std::size_t>, Similar> similar;  // by submaps a and b
  for (std::size_t k = 0; k < database_.keyframes.size(); ++k) {
    const MapKeyframe& keyframe = database_.keyframes[k];
    const std::size_t own = submap_of_[k];
    const auto of_another = [&](std::size_t i) { return submap_of_[i] != own; };
    std::set<std::size_t> others;  // submaps that show the keyframe's place
    for (const std::size_t i :
         database_.index.candidates(keyframe.descriptors, config_.candidates, of_another))
      if (!others.contains(submap_of_[i]) && is_alike(keyframe, database_.keyframes[i], config_.min_matches))
        others.insert(submap_of_[i]);
    for (const std::size_t other : others) {
      Similar& of_pair = similar[std::minmax(own, other)];
      ++(own < other ? of_pair.in_a : of_pair.in_b);
    }
  }
  std::vector<CandidatePair> found;
  for (const auto& [pair, count] : similar)
    if (std::max(count.in_a, count.in_b) >= config_.min_similar)
      found.push_back({pair.first, pair.second, count.in_a + count.in_b});
  return best_partners(std::move(found), submaps_, config_.partners);
}

std::vector<std::pair<std::size_t, std::size_t>> similar_keyframes(const Submap& a, const Submap& b,
                                                                   const SimilarConfig& config) {
  DistinctKeyframes of_a = distinct_keyframes(a, config.min_step);
  const DistinctKeyframes of_b = distinct_keyframes(b, config.min_step);
  update_index(of_a.database);
  of_a.database.index.sort();
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
