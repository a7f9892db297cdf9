// keyframe_retrieval.cpp: an index over the features of all keyframes.
#include "mapping/building/keyframe_retrieval.hpp"

#include <algorithm>
#include <map>

#include "mapping/localization/place_matching.hpp"
#include "mapping/odometry/keyframe_graph.hpp"

namespace roomradar {

void KeyframeRetrieval::add(const Submap& submap) {
  const auto& keyframes = submap.keyframes.keyframes;
  std::vector<MapKeyframe> added;
  std::vector<std::size_t> index_of;  // of the added keyframes, in the submap
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    const auto step = [&] {
      return view_distance(keyframes[index_of.back()].T_world_camera.inverse() * keyframes[k].T_world_camera);
    };
    if (!added.empty() && step() < config_.min_step) continue;
    MapKeyframe& kept = added.emplace_back();
    index_of.push_back(k);
    kept.descriptors = keyframes[k].descriptors;
    kept.descriptors.resize(std::min(kept.descriptors.size(), FeatureIndex::kIndexedFeatures));
    kept.descriptors.shrink_to_fit();
  }
  for (std::size_t j = 0; j < added.size(); ++j) {
    std::map<std::size_t, std::size_t> count_in;  // by submap
    for (const std::size_t i : most_alike(added[j], database_, config_.candidates, config_.min_matches)) {
      const std::size_t a = submap_of_[i];
      if (++count_in[a] <= config_.per_submap) found_.push_back({a, submaps_, keyframe_of_[i], index_of[j]});
    }
  }
  submap_of_.resize(submap_of_.size() + added.size(), submaps_++);
  keyframe_of_.insert(keyframe_of_.end(), index_of.begin(), index_of.end());
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
