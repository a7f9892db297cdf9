// keyframe_pairs.cpp: chooses and aligns pairs of keyframes.
#include "mapping/odometry/keyframe_pairs.hpp"

#include <algorithm>
#include <future>
#include <utility>

#include "mapping/alignment/packed_view.hpp"

namespace roomradar {
namespace {

/// One direction of a pair.
struct HalfPair {
  std::size_t reference = 0, live = 0;
  Tracking live_in_reference;
};

constexpr auto by_newer = [](const KeyframePair& a, const KeyframePair& b) {
  return std::pair(a.newer, a.older) < std::pair(b.newer, b.older);
};

/// Sorted by reference, so that each thread prepares a reference once and holds only one in memory.
constexpr auto by_reference = [](const HalfPair& a, const HalfPair& b) {
  return std::pair(a.reference, a.live) < std::pair(b.reference, b.live);
};

bool is_aligned(std::span<const KeyframePair> aligned, std::size_t older, std::size_t newer) {
  return std::binary_search(aligned.begin(), aligned.end(), KeyframePair{older, newer, {}, {}}, by_newer);
}

/// Merges sorted pairs into sorted pairs.
void merge_into(std::vector<KeyframePair>& pairs, std::vector<KeyframePair> more) {
  const auto middle = static_cast<std::ptrdiff_t>(pairs.size());
  pairs.insert(pairs.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  std::inplace_merge(pairs.begin(), pairs.begin() + middle, pairs.end(), by_newer);
}

void align_halves(std::span<const Keyframe> keyframes, std::span<HalfPair> halves,
                  const ConnectConfig& config) {
  KeyframeCache lives(config.graph.cached_keyframes, PreparedParts::kLive);
  ViewPyramid pyramid;
  TargetView target;
  for (std::size_t i = 0; i < halves.size(); ++i) {
    HalfPair& half = halves[i];
    const Keyframe &reference = keyframes[half.reference], &live = keyframes[half.live];
    if (i == 0 || halves[i - 1].reference != half.reference) {
      restore(unpacked(*reference.view), config.view, pyramid);
      make_target_view(pyramid, Eigen::Isometry3d::Identity(), config.view, target);
    }
    const auto source = lives.get(half.live, *live.view, config.view);
    half.live_in_reference =
        align(source->live, target, reference.T_world_camera.inverse() * live.T_world_camera, config.align);
  }
}

}  // namespace

std::vector<std::size_t> choose_older(std::span<const Keyframe> keyframes, std::size_t newer,
                                      std::span<const KeyframePair> aligned,
                                      const KeyframeGraphConfig& config) {
  const std::vector<std::size_t> near = keyframes_near(
      keyframes.first(newer), keyframes[newer].T_world_camera, config.furthest, keyframes[newer].part);
  struct Candidate {
    std::size_t keyframe, rank;  // rank in the order of view_distance()
  };
  std::vector<Candidate> candidates;
  for (std::size_t rank = 0; rank < near.size(); ++rank) candidates.push_back({near[rank], rank});
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.keyframe < b.keyframe; });
  const std::size_t groups =
      std::min(candidates.size(), static_cast<std::size_t>(std::max(config.max_edges_rebuild, 1)));
  std::vector<std::size_t> chosen;
  for (std::size_t group = 0; group < groups; ++group) {
    const auto begin = candidates.begin() + static_cast<std::ptrdiff_t>(group * candidates.size() / groups);
    const auto end =
        candidates.begin() + static_cast<std::ptrdiff_t>((group + 1) * candidates.size() / groups);
    const auto cost = [&](const Candidate& c) {
      return std::pair(!is_aligned(aligned, c.keyframe, newer), c.rank);
    };
    const auto best = std::min_element(
        begin, end, [&](const Candidate& a, const Candidate& b) { return cost(a) < cost(b); });
    chosen.push_back(best->keyframe);
  }
  return chosen;
}

std::vector<KeyframePair> align_pairs(std::span<const Keyframe> keyframes, std::size_t first,
                                      std::size_t last, std::span<const KeyframePair> aligned,
                                      const ConnectConfig& config, int threads) {
  std::vector<HalfPair> halves;
  for (std::size_t newer = first; newer < last; ++newer) {
    for (const std::size_t older : choose_older(keyframes, newer, aligned, config.graph)) {
      if (is_aligned(aligned, older, newer)) continue;
      halves.push_back({older, newer, {}});
      halves.push_back({newer, older, {}});
    }
  }
  std::sort(halves.begin(), halves.end(), by_reference);
  const std::span<HalfPair> all(halves);
  const std::size_t own = threads > 1 ? all.size() / 2 : all.size();
  auto others = std::async(threads > 1 ? std::launch::async : std::launch::deferred,
                           [&] { align_halves(keyframes, all.subspan(own), config); });
  align_halves(keyframes, all.first(own), config);
  others.get();

  std::vector<KeyframePair> pairs;
  for (const HalfPair& there : halves) {
    if (there.reference > there.live) continue;
    const auto back = std::lower_bound(halves.begin(), halves.end(),
                                       HalfPair{there.live, there.reference, {}}, by_reference);
    pairs.push_back({there.reference, there.live, there.live_in_reference, back->live_in_reference});
  }
  std::sort(pairs.begin(), pairs.end(), by_newer);
  return pairs;
}

void close_loops(KeyframeGraph& graph, std::vector<KeyframePair> aligned, const ConnectConfig& config) {
  merge_into(aligned, align_pairs(graph.keyframes, 1, graph.keyframes.size(), aligned, config, 2));
  graph.constraints.clear();
  graph.loops_found = graph.loops_rejected = 0;
  for (const KeyframePair& pair : aligned) add_constraints(graph, pair, config.graph);
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) {
    connect_flow(graph, i);
    connect_recorded(graph, i);
  }
}

std::size_t PairAligner::advance(const std::vector<Keyframe>& keyframes, const ConnectConfig& config) {
  // A keyframe followed by kNewer keyframes is final; few frames refine it later.
  constexpr std::size_t kNewer = 4;
  constexpr std::size_t kBatch = 8;  // in a batch, a prepared reference serves several pairs
  const std::size_t left = keyframes.size() - std::min(keyframes.size(), kNewer);
  const std::size_t until = left - left % kBatch;  // depends on nothing else, so a resumed scan is the same
  if (until <= final_) return final_;
  wait();
  const std::size_t first = std::exchange(final_, until);
  const auto last = keyframes.begin() + static_cast<std::ptrdiff_t>(until);
  batch_ = std::async(std::launch::async, [config, first, keyframes = std::vector(keyframes.begin(), last)] {
    return align_pairs(keyframes, first, keyframes.size(), {}, config, 1);
  });
  return final_;
}

void PairAligner::wait() {
  if (batch_.valid()) merge_into(aligned_, batch_.get());
}

std::vector<KeyframePair> PairAligner::finish() {
  wait();
  return aligned_;
}

}  // namespace roomradar
