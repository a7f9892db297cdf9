// keyframe_retrieval.hpp: which recordings of a building may show the same place.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "mapping/building/submap.hpp"

namespace roomradar {

/// Two submaps, and pairs of their keyframes that look similar.
struct CandidatePair {
  std::size_t a = 0, b = 0;                                    ///< submaps, a < b
  std::vector<std::pair<std::size_t, std::size_t>> keyframes;  ///< of a, of b; sorted, each pair once
};

struct RetrievalConfig {
  std::size_t candidates = 24;  ///< keyframes of other submaps that are considered for each keyframe
  double min_step = 0.25;       ///< min view_distance() of the keyframes of a submap that are compared
  int min_matches = 15;         ///< min number of features that match
  std::size_t per_submap = 2;   ///< of the candidates, max number in the same submap
  std::size_t min_pairs = 2;    ///< min number of keyframe pairs of a pair of submaps
};

/// Finds similar keyframes of different submaps, by an index of their features. Submaps are added one after
/// the other, and only their strongest features are kept (10 kB per keyframe).
class KeyframeRetrieval {
 public:
  explicit KeyframeRetrieval(const RetrievalConfig& config = {}) : config_(config) {}

  /// Compares a submap's keyframes with those added before, then adds them.
  void add(const Submap& submap);
  /// Returns the pairs of submaps found so far, by number of the submap in the order in which they were
  /// added. Sorted by a, then b.
  [[nodiscard]] std::vector<CandidatePair> pairs() const;
  [[nodiscard]] std::size_t keyframes() const { return database_.keyframes.size(); }

 private:
  struct Found {
    std::size_t a, b, keyframe_a, keyframe_b;
    auto operator<=>(const Found&) const = default;
  };
  RetrievalConfig config_;
  KeyframeDatabase database_;             ///< of all submaps, with descriptors only
  std::vector<std::size_t> keyframe_of_;  ///< by keyframe of the database: its index in the submap
  std::vector<std::size_t> submap_of_;    ///< by keyframe of the database
  std::size_t submaps_ = 0;
  std::vector<Found> found_;
};

}  // namespace roomradar
