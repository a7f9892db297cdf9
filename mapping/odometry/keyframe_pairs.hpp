// keyframe_pairs.hpp: alignments of keyframes whose depth is final, and the pose graph built from them.
#pragma once
#include <cstddef>
#include <future>
#include <span>
#include <vector>

#include "mapping/odometry/keyframe_graph.hpp"

namespace roomradar {

/// Chooses at most max_edges_rebuild older keyframes with views similar to that of `newer`. Divides the
/// keyframes with similar views, in order of time, into max_edges_rebuild groups, so that each visit to a
/// part of the room is represented. From each group, chooses a keyframe that is already aligned with `newer`
/// if there is one; among several, the one with the most similar view.
/// @param aligned  pairs that are aligned already, sorted by (newer, older)
std::vector<std::size_t> choose_older(std::span<const Keyframe> keyframes, std::size_t newer,
                                      std::span<const KeyframePair> aligned,
                                      const KeyframeGraphConfig& config);

/// Aligns keyframes [first, last) with older ones, which choose_older() chooses. Starts from their current
/// poses. Returns the pairs sorted by (newer, older). Leaves out pairs that are in `aligned`. Deterministic.
/// @param threads  number of threads, 1 or 2
std::vector<KeyframePair> align_pairs(std::span<const Keyframe> keyframes, std::size_t first,
                                      std::size_t last, std::span<const KeyframePair> aligned,
                                      const ConnectConfig& config, int threads);

/// Replaces all constraints. The new ones are from `aligned` and from the pairs that choose_older() chooses,
/// which are aligned on two threads. Deterministic.
/// @param aligned  pairs that are aligned already, sorted by (newer, older)
void close_loops(KeyframeGraph& graph, std::vector<KeyframePair> aligned, const ConnectConfig& config);

/// Aligns keyframes with older ones on its own thread while more keyframes are added. Not thread safe.
class PairAligner {
 public:
  /// Call whenever a keyframe was added. Once advance() has returned n, callers must not change the depth of
  /// keyframes 0 to n - 1. Aligns these final keyframes in batches; waits if the last batch is still being
  /// aligned.
  /// @return the number n of keyframes whose depth is final: a multiple of 8 that excludes at least the
  ///         newest four
  std::size_t advance(const std::vector<Keyframe>& keyframes, const ConnectConfig& config);
  /// Waits for the last batch, and returns all pairs aligned so far, sorted by (newer, older).
  std::vector<KeyframePair> finish();

 private:
  void wait();

  std::vector<KeyframePair> aligned_;
  std::size_t final_ = 0;  ///< number of keyframes whose pairs are in aligned_ or in batch_
  std::future<std::vector<KeyframePair>> batch_;
};

}  // namespace roomradar
