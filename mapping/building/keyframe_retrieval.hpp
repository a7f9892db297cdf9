// keyframe_retrieval.hpp: finds recordings of a building, and their keyframes, that may show the same place.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "mapping/building/submap.hpp"

namespace roomradar {

/// Two submaps that may show the same place.
struct CandidatePair {
  std::size_t a = 0, b = 0;  ///< submaps, a < b
  std::size_t similar = 0;   ///< keyframes of both that look similar to one of the other submap
};

struct RetrievalConfig {
  double min_step = 0.25;       ///< min view_distance() of the keyframes of a submap that are compared
  int min_matches = 15;         ///< min number of features that match
  std::size_t candidates = 24;  ///< max keyframes of other submaps to compare with a keyframe
  std::size_t min_similar = 2;  ///< min number of similar keyframes in one of the submaps of a pair
  std::size_t partners = 16;    ///< max pairs per submap, those with the most similar keyframes
};

/// Finds submaps with similar keyframes, by an index of their features. Of each submap, only the strongest
/// features are kept (10 kB per keyframe, and 19 to 38 kB of the index).
class KeyframeRetrieval {
 public:
  explicit KeyframeRetrieval(const RetrievalConfig& config = {}) : config_(config) {}

  /// Adds a submap, which gets the next number.
  void add(const Submap& submap);
  /// Compares the keyframes of each submap with similar ones of all others. Returns the pairs of submaps that
  /// look alike, sorted by a, then b. A pair is among the `partners` best pairs of one of its submaps, so the
  /// number of pairs grows linearly with the number of submaps.
  [[nodiscard]] std::vector<CandidatePair> find_pairs();
  [[nodiscard]] std::size_t keyframes() const { return database_.keyframes.size(); }

 private:
  RetrievalConfig config_;
  KeyframeDatabase database_;           ///< of all submaps, with descriptors only
  std::vector<std::size_t> submap_of_;  ///< by keyframe of the database
  std::size_t submaps_ = 0;
};

struct SimilarConfig {
  double min_step = 0.25;        ///< min view_distance() of the keyframes of a submap that are compared
  int min_matches = 15;          ///< min number of features that match
  std::size_t candidates = 8;    ///< max keyframes of a to compare with a keyframe of b
  std::size_t per_keyframe = 2;  ///< max pairs to return per keyframe of b
};

/// Returns pairs of keyframes of two submaps (of a, of b) that look similar, sorted. Depends only on the
/// two submaps.
std::vector<std::pair<std::size_t, std::size_t>> similar_keyframes(const Submap& a, const Submap& b,
                                                                   const SimilarConfig& config = {});

}  // namespace roomradar
