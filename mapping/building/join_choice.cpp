// join_choice.cpp: finds conflicts along the shortest ways between submaps, and breaks them.
#include "mapping/building/join_choice.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <queue>
#include <set>
#include <utility>

#include "mapping/building/hitting_set.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr double kAnyLength_m = std::numeric_limits<double>::infinity();
constexpr double kLongestOverlap_m = 20.0;  ///< of the ways by which views are predicted

/// A way from one submap (its start) over joins to another.
struct Way {
  Eigen::Isometry3d T_start_end = Eigen::Isometry3d::Identity();  ///< of the two submaps' worlds
  std::vector<std::size_t> joins;
  std::size_t leaves_by = 0, arrives_at = 0;  ///< keyframes of the start and of the end
  double length_m = 0.0;                      ///< within the submaps, from leaves_by to arrives_at

  /// Joins count as some metres, so that of two ways of the same length the one with fewer joins is taken.
  [[nodiscard]] double cost() const { return length_m + 2.0 * static_cast<double>(joins.size()); }
};

/// The submaps and those of their joins that are used.
struct UsedJoins {
  std::span<const GraphSubmap> submaps;
  std::span<const GraphJoin> joins;
  std::vector<bool> is_used;
  std::vector<std::vector<std::size_t>> of_submap;  ///< joins, by submap
};

double distance_m(const GraphSubmap& submap, std::size_t i, std::size_t j) {
  return (submap.T_submap_keyframe[i].translation() - submap.T_submap_keyframe[j].translation()).norm();
}

/// Returns the way that goes on over a join.
Way extended(const UsedJoins& used, const Way& way, std::size_t at, std::size_t j) {
  const GraphJoin& join = used.joins[j];
  const bool from_a = join.a == at;
  const auto near_of = [&](const KeyframeLink& link) { return from_a ? link.a : link.b; };
  const std::vector<KeyframeLink>& links = join.join.links;
  // By the link nearest to where the submap was entered; from the start, by the one in the middle.
  const KeyframeLink& link =
      way.joins.empty() ? links[links.size() / 2]
                        : *std::min_element(links.begin(), links.end(), [&](const auto& x, const auto& y) {
                            return distance_m(used.submaps[at], way.arrives_at, near_of(x)) <
                                   distance_m(used.submaps[at], way.arrives_at, near_of(y));
                          });
  const Eigen::Isometry3d T_a_b = used.submaps[join.a].T_submap_keyframe[link.a] * link.T_a_b *
                                  used.submaps[join.b].T_submap_keyframe[link.b].inverse();
  Way next = way;
  next.T_start_end = way.T_start_end * (from_a ? T_a_b : T_a_b.inverse());
  if (way.joins.empty())
    next.leaves_by = near_of(link);
  else
    next.length_m += distance_m(used.submaps[at], way.arrives_at, near_of(link));
  next.arrives_at = from_a ? link.b : link.a;
  next.joins.push_back(j);
  return next;
}

/// Returns the shortest way from `start` to each submap that can be reached. Source: Dijkstra 1959.
/// @param longest_m  longer ways are not searched
/// @param without    a join that no way may use
std::vector<std::optional<Way>> ways_from(const UsedJoins& used, std::size_t start, double longest_m,
                                          std::optional<std::size_t> without = {}) {
  struct Open {
    Way way;
    std::size_t at = 0;
    bool operator<(const Open& other) const {  // the queue gives the greatest first
      return std::pair(way.cost(), at) > std::pair(other.way.cost(), other.at);
    }
  };
  std::vector<std::optional<Way>> found(used.submaps.size());
  std::priority_queue<Open> open;
  open.push({{}, start});
  while (!open.empty()) {
    const Open next = open.top();
    open.pop();
    if (found[next.at]) continue;
    found[next.at] = next.way;
    for (const std::size_t j : used.of_submap[next.at]) {
      const GraphJoin& join = used.joins[j];
      const std::size_t to = join.a == next.at ? join.b : join.a;
      if (j == without || !used.is_used[j] || found[to]) continue;
      Way way = extended(used, next.way, next.at, j);
      if (way.length_m <= longest_m) open.push({std::move(way), to});
    }
  }
  return found;
}

/// Records a cycle of joins if it does not close.
void add_if_open(double off_m, double length_m, Conflict joins, std::set<Conflict>& conflicts) {
  constexpr double kAllowed_m = 0.3, kDrift = 0.03;
  if (off_m <= kAllowed_m + kDrift * length_m) return;
  std::sort(joins.begin(), joins.end());
  conflicts.insert(std::move(joins));
}

/// Compares each join with the shortest way around it. Returns whether a cycle is open that was not known.
bool find_open_cycles(const UsedJoins& used, std::set<Conflict>& conflicts) {
  const std::size_t known = conflicts.size();
  constexpr double kLongest_m = 100.0;  // beyond, drift explains almost everything
  for (std::size_t j = 0; j < used.joins.size(); ++j) {
    if (!used.is_used[j]) continue;
    const GraphJoin& join = used.joins[j];
    const std::optional<Way> way = ways_from(used, join.a, kLongest_m, j)[join.b];
    if (!way) continue;
    const GraphSubmap &a = used.submaps[join.a], &b = used.submaps[join.b];
    const auto length_m = [&](const KeyframeLink& link) {
      return way->length_m + distance_m(a, way->leaves_by, link.a) + distance_m(b, way->arrives_at, link.b);
    };
    const KeyframeLink& link =
        *std::min_element(join.join.links.begin(), join.join.links.end(),
                          [&](const auto& x, const auto& y) { return length_m(x) < length_m(y); });
    const Eigen::Isometry3d T_by_way =
        a.T_submap_keyframe[link.a].inverse() * way->T_start_end * b.T_submap_keyframe[link.b];
    Conflict cycle = way->joins;
    cycle.push_back(j);
    add_if_open(motion_length_m(link.T_a_b.inverse() * T_by_way), length_m(link), std::move(cycle),
                conflicts);
  }
  return conflicts.size() > known;
}

/// Compares each join that is not in a spanning tree with the way through the tree: these cycles are a basis
/// of all. Returns as find_open_cycles().
bool find_open_basis_cycles(const UsedJoins& used, std::set<Conflict>& conflicts) {
  const std::size_t known = conflicts.size();
  std::vector<bool> is_placed(used.submaps.size(), false);
  for (std::size_t root = 0; root < used.submaps.size(); ++root) {
    if (is_placed[root]) continue;
    const std::vector<std::optional<Way>> ways = ways_from(used, root, kAnyLength_m);
    for (std::size_t s = 0; s < ways.size(); ++s) is_placed[s] = is_placed[s] || ways[s];
    for (std::size_t j = 0; j < used.joins.size(); ++j) {
      const GraphJoin& join = used.joins[j];
      if (!used.is_used[j] || !ways[join.a]) continue;
      const Way &to_a = *ways[join.a], &to_b = *ways[join.b];
      const auto [last_a, last_b] =
          std::mismatch(to_a.joins.begin(), to_a.joins.end(), to_b.joins.begin(), to_b.joins.end());
      Conflict cycle(last_a, to_a.joins.end());  // the joins that only one of the ways has
      cycle.insert(cycle.end(), last_b, to_b.joins.end());
      if (std::find(cycle.begin(), cycle.end(), j) != cycle.end()) continue;  // in the tree
      const GraphSubmap &a = used.submaps[join.a], &b = used.submaps[join.b];
      const KeyframeLink& link = join.join.links[join.join.links.size() / 2];
      const Eigen::Isometry3d T_by_ways = (to_a.T_start_end * a.T_submap_keyframe[link.a]).inverse() *
                                          to_b.T_start_end * b.T_submap_keyframe[link.b];
      const double length_m = to_a.length_m + to_b.length_m +
                              (to_a.joins.empty() ? 0.0 : distance_m(a, to_a.arrives_at, link.a)) +
                              (to_b.joins.empty() ? 0.0 : distance_m(b, to_b.arrives_at, link.b));
      cycle.push_back(j);
      add_if_open(motion_length_m(link.T_a_b.inverse() * T_by_ways), length_m, std::move(cycle), conflicts);
    }
  }
  return conflicts.size() > known;
}

/// Returns the keyframes of the way's ends that have nearly the same view by the way, if it is short enough
/// to say so. Leaves out what the way's only join has tested already.
std::vector<PredictedPair> overlap_of(const UsedJoins& used, const Way& way, std::size_t a, std::size_t b) {
  constexpr double kDrift = 0.02;
  const GraphSubmap &from = used.submaps[a], &to = used.submaps[b];
  const double tested_m = way.joins.size() == 1 ? JoinConfig{}.near_m : 0.0;
  std::vector<PredictedPair> pairs;
  for (std::size_t k = 0; k < to.T_submap_keyframe.size(); ++k) {
    const double from_end_m = distance_m(to, way.arrives_at, k);
    if (way.length_m + from_end_m > kLongestOverlap_m) continue;
    if (tested_m > 0.0) {
      const std::vector<KeyframeLink>& links = used.joins[way.joins.front()].join.links;
      const bool is_b = used.joins[way.joins.front()].b == b;
      if (std::any_of(links.begin(), links.end(), [&](const KeyframeLink& link) {
            return distance_m(to, is_b ? link.b : link.a, k) < tested_m;
          }))
        continue;
    }
    const std::size_t first = pairs.size();
    predict_pairs(from.T_submap_keyframe, way.T_start_end * to.T_submap_keyframe[k], k, 0.0, pairs);
    for (std::size_t p = first; p < pairs.size(); ++p)
      pairs[p].drift_m = kDrift * (way.length_m + from_end_m + distance_m(from, way.leaves_by, pairs[p].a));
  }
  std::erase_if(pairs, [](const PredictedPair& pair) { return pair.drift_m > kDrift * kLongestOverlap_m; });
  return pairs;
}

/// Joins that put two submaps at the same place, where they look different.
struct Overlap {
  Conflict joins;
  double cost = 0.0;  ///< of leaving it so; 0: they look the same, or nothing can be said
  Eigen::Isometry3d T_a_b = Eigen::Isometry3d::Identity();  ///< of the two submaps' worlds
};

/// A few keyframes that are not recognised prove nothing. Several in a row do: chance does not fail in one
/// place only.
Overlap judged(const PlacementTest& test, const Way& way) {
  constexpr int kMinMiss = 4;
  constexpr double kSure = 4.0;  // keyframes in a row
  Overlap overlap{way.joins, 0.0, way.T_start_end};
  std::sort(overlap.joins.begin(), overlap.joins.end());
  if (test.longest_miss >= kMinMiss)
    overlap.cost = test.longest_miss / kSure;
  else if (test.expected >= kMinMiss && test.agreement() < JoinConfig{}.min_agreement)
    overlap.cost = 1.0;
  return overlap;
}

/// By pair of submaps and the joins of the way between them.
using Overlaps = std::map<std::pair<std::pair<std::size_t, std::size_t>, Conflict>, Overlap>;

/// Compares all submaps that ways put at the same place. Returns whether a new one looks different.
bool find_overlaps(const UsedJoins& used, const TestOverlap& test_overlap, Overlaps& overlaps) {
  bool is_new = false;
  for (std::size_t a = 0; a < used.submaps.size(); ++a) {
    const std::vector<std::optional<Way>> ways = ways_from(used, a, kLongestOverlap_m);
    for (std::size_t b = a + 1; b < used.submaps.size(); ++b) {
      if (!ways[b]) continue;
      const auto key = std::pair(std::pair(a, b), ways[b]->joins);
      if (overlaps.contains(key)) continue;
      const std::vector<PredictedPair> pairs = overlap_of(used, *ways[b], a, b);
      Overlap& overlap = overlaps[key];
      if (!pairs.empty()) overlap = judged(test_overlap(a, b, pairs), *ways[b]);
      is_new |= overlap.cost > 0.0;
    }
  }
  return is_new;
}

/// Cost of refusing a join.
double cost_of(const GraphSubmap& submap, const GraphJoin& join) {
  constexpr double kRoom_m = 5.0;  // a look-alike room is not longer
  double span_m = 0.0;
  for (const KeyframeLink& link : join.join.links)
    span_m = std::max(span_m, distance_m(submap, join.join.links.front().b, link.b));
  const double quality = std::clamp((join.join.agreement - 0.7) / 0.3, 0.2, 1.0);
  return (0.5 + std::min(span_m / kRoom_m, 2.0)) * quality;
}

/// Conflicts between joins, and what breaking them costs: first of the joins, then of leaving an overlap as
/// it is.
struct Conflicts {
  std::vector<Conflict> all;
  std::vector<double> costs;
};

Conflicts all_conflicts(const std::set<Conflict>& cycles, const Overlaps& overlaps,
                        const std::vector<double>& join_costs) {
  Conflicts conflicts{{cycles.begin(), cycles.end()}, join_costs};
  // Two ways may put a pair at the same place: that is left once.
  std::vector<std::pair<const Overlap*, std::size_t>> left;  // of the pair at hand, with its element
  std::pair<std::size_t, std::size_t> pair_at_hand;
  for (const auto& [key, overlap] : overlaps) {
    if (overlap.cost <= 0.0) continue;
    if (key.first != pair_at_hand) left.clear();
    pair_at_hand = key.first;
    const Eigen::Isometry3d& T_a_b = overlap.T_a_b;
    auto same = std::find_if(left.begin(), left.end(), [&T_a_b](const auto& one) {
      return motion_length_m(one.first->T_a_b.inverse() * T_a_b) < 1.0;
    });
    if (same == left.end()) {
      same = left.insert(same, {&overlap, conflicts.costs.size()});
      conflicts.costs.push_back(overlap.cost);
    }
    double& cost = conflicts.costs[same->second];
    cost = std::max(cost, overlap.cost);
    conflicts.all.push_back(overlap.joins);
    conflicts.all.back().push_back(same->second);
  }
  return conflicts;
}

}  // namespace

std::vector<bool> choose_joins(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
                               const TestOverlap& test_overlap) {
  UsedJoins used{submaps, joins, std::vector<bool>(joins.size(), true), {}};
  used.of_submap.resize(submaps.size());
  std::vector<double> costs;
  for (std::size_t j = 0; j < joins.size(); ++j) {
    used.of_submap[joins[j].a].push_back(j);
    used.of_submap[joins[j].b].push_back(j);
    costs.push_back(cost_of(submaps[joins[j].b], joins[j]));
  }
  std::set<Conflict> cycles;
  Overlaps overlaps;
  for (;;) {
    // Overlaps are compared where no cycle is open any more.
    bool is_new = find_open_cycles(used, cycles) || find_open_basis_cycles(used, cycles);
    if (!is_new && test_overlap) is_new = find_overlaps(used, test_overlap, overlaps);
    if (!is_new) return used.is_used;
    const Conflicts conflicts = all_conflicts(cycles, overlaps, costs);
    used.is_used.assign(joins.size(), true);
    for (const std::size_t refused : cheapest_hitting_set(conflicts.all, conflicts.costs))
      if (refused < joins.size()) used.is_used[refused] = false;
  }
}

std::vector<LookAlike> find_look_alikes(std::span<const PlacedSubmap> submaps, std::size_t part,
                                        std::span<const GraphJoin> refused) {
  constexpr std::size_t kMostPerJoin = 12;
  constexpr double kSamePlace_m = 0.5, kSamePlace_rad = 0.5;
  std::vector<LookAlike> look_alikes;
  for (const GraphJoin& one : refused) {
    const PlacedSubmap &a = submaps[one.a], &b = submaps[one.b];
    if (a.part != part || b.part != part) continue;
    for (const KeyframeLink& link : spread_evenly(one.join.links, kMostPerJoin)) {
      const Eigen::Isometry3d &T_world_a = a.T_building_keyframe[link.a],
                              &T_world_b = b.T_building_keyframe[link.b];
      const Eigen::Isometry3d T_b_a = T_world_b * link.T_a_b.inverse() * T_world_a.inverse();
      if (is_near(T_b_a * T_world_a, T_world_a, kSamePlace_m, kSamePlace_rad)) continue;
      look_alikes.push_back({T_world_a.translation(), T_b_a});
      look_alikes.push_back({T_world_b.translation(), T_b_a.inverse()});
    }
  }
  return look_alikes;
}

}  // namespace roomradar
