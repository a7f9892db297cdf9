// building_graph.cpp: places submaps by the joins that are used, then solves the pose graph.
#include "mapping/building/building_graph.hpp"

#include <algorithm>
#include <deque>
#include <numeric>
#include <optional>

#include "mapping/building/join_choice.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/odometry/pose_graph.hpp"
#include "mapping/types/disjoint_sets.hpp"

namespace roomradar {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Returns the link in the middle of a join.
const KeyframeLink& middle_of(const SubmapJoin& join) { return join.links[join.links.size() / 2]; }

/// A spanning tree of the submaps, by joins.
class JoinTree {
 public:
  JoinTree(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
           const std::vector<bool>& is_used)
      : submaps_(submaps), joins_(joins), by_submap_(submaps.size()) {
    std::vector<std::size_t> order;
    for (std::size_t j = 0; j < joins.size(); ++j)
      if (is_used[j]) order.push_back(j);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t x, std::size_t y) {
      return joins[x].join.agreeing > joins[y].join.agreeing;
    });
    DisjointSets<std::size_t> parts(submaps.size());
    for (const std::size_t j : order) {
      if (parts.find(joins[j].a) == parts.find(joins[j].b)) continue;
      parts.join(joins[j].a, joins[j].b);
      by_submap_[joins[j].a].push_back(j);
      by_submap_[joins[j].b].push_back(j);
    }
  }

  /// Places the submaps of each part by the tree. Parts are numbered by their first submap.
  void place(std::vector<Eigen::Isometry3d>& T_building_submap, std::vector<std::size_t>& part) const {
    T_building_submap.assign(submaps_.size(), Eigen::Isometry3d::Identity());
    part.assign(submaps_.size(), submaps_.size());
    std::size_t parts = 0;
    for (std::size_t root = 0; root < submaps_.size(); ++root) {
      if (part[root] != submaps_.size()) continue;
      part[root] = parts;
      std::deque<std::size_t> open{root};
      while (!open.empty()) {
        const std::size_t at = open.front();
        open.pop_front();
        for (const std::size_t j : by_submap_[at]) {
          const bool from_a = joins_[j].a == at;
          const std::size_t next = from_a ? joins_[j].b : joins_[j].a;
          if (part[next] != submaps_.size()) continue;
          const KeyframeLink& link = middle_of(joins_[j].join);
          const Eigen::Isometry3d T_a_b = submaps_[joins_[j].a].T_submap_keyframe[link.a] * link.T_a_b *
                                          submaps_[joins_[j].b].T_submap_keyframe[link.b].inverse();
          T_building_submap[next] = T_building_submap[at] * (from_a ? T_a_b : T_a_b.inverse());
          part[next] = parts;
          open.push_back(next);
        }
      }
      ++parts;
    }
  }

 private:
  std::span<const GraphSubmap> submaps_;
  std::span<const GraphJoin> joins_;
  std::vector<std::vector<std::size_t>> by_submap_;  ///< joins of the tree
};

/// The pose graph of all keyframes.
class Keyframes {
 public:
  Keyframes(std::span<const GraphSubmap> submaps, const std::vector<Eigen::Isometry3d>& T_building_submap) {
    for (std::size_t s = 0; s < submaps.size(); ++s) {
      first_.push_back(poses.size());
      for (const Eigen::Isometry3d& T : submaps[s].T_submap_keyframe)
        poses.push_back(T_building_submap[s] * T);
    }
    first_.push_back(poses.size());
  }
  [[nodiscard]] std::size_t index(std::size_t submap, std::size_t keyframe) const {
    return first_[submap] + keyframe;
  }
  [[nodiscard]] std::span<const Eigen::Isometry3d> of(std::size_t submap) const {
    return std::span(poses).subspan(first_[submap], first_[submap + 1] - first_[submap]);
  }
  std::vector<Eigen::Isometry3d> poses;

 private:
  std::vector<std::size_t> first_;
};

Matrix6d information_of(double sigma_m, double sigma_rad) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

/// Adds the relative poses that tracking measured in one submap: of successive keyframes, and of some others
/// with similar views, by which tracking closed its loops.
void add_own_constraints(const GraphSubmap& submap, std::size_t first, const GraphConfig& config,
                         std::vector<PoseConstraint>& constraints) {
  constexpr std::size_t kSteps = 2, kMostSimilar = 4;
  constexpr double kSimilarView = 1.0;  // of view_distance()
  const auto& poses = submap.T_submap_keyframe;
  const auto add = [&](std::size_t i, std::size_t j, double times) {
    constraints.push_back({first + i, first + j, poses[i].inverse() * poses[j],
                           information_of(times * config.step_sigma_m, times * config.step_sigma_rad),
                           false});
  };
  for (std::size_t j = 0; j < poses.size(); ++j) {
    for (std::size_t step = 1; step <= std::min(kSteps, j); ++step)
      add(j - step, j, std::sqrt(static_cast<double>(step)));
    std::vector<std::pair<double, std::size_t>> similar;
    for (std::size_t i = 0; i + kSteps < j; ++i)
      if (const double distance = view_distance(poses[i].inverse() * poses[j]); distance < kSimilarView)
        similar.emplace_back(distance, i);
    std::sort(similar.begin(), similar.end());
    for (std::size_t k = 0; k < std::min(kMostSimilar, similar.size()); ++k) add(similar[k].second, j, 2.0);
  }
}

std::vector<PoseConstraint> constraints_of(std::span<const GraphSubmap> submaps,
                                           std::span<const GraphJoin> joins, const std::vector<bool>& is_used,
                                           const Keyframes& keyframes, const GraphConfig& config) {
  std::vector<PoseConstraint> constraints;
  for (std::size_t s = 0; s < submaps.size(); ++s)
    add_own_constraints(submaps[s], keyframes.index(s, 0), config, constraints);
  for (std::size_t j = 0; j < joins.size(); ++j) {
    if (!is_used[j]) continue;
    for (const KeyframeLink& link : joins[j].join.links)
      constraints.push_back({keyframes.index(joins[j].a, link.a), keyframes.index(joins[j].b, link.b),
                             link.T_a_b, link.information, true});
  }
  return constraints;
}

double off_m_of(const GraphJoin& join, const Keyframes& keyframes) {
  std::vector<double> off_m;
  for (const KeyframeLink& link : join.join.links)
    off_m.push_back(
        motion_length_m(link.T_a_b.inverse() * keyframes.poses[keyframes.index(join.a, link.a)].inverse() *
                        keyframes.poses[keyframes.index(join.b, link.b)]));
  return median(std::move(off_m));
}

/// Solves, and refuses joins that remain off, until the rest agrees.
void solve(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
           const std::vector<bool>& is_constant, const GraphConfig& config, Keyframes& keyframes,
           BuildingGraph& graph) {
  for (;;) {
    (void)optimise_pose_graph(
        keyframes.poses, constraints_of(submaps, joins, graph.is_used, keyframes, config), {}, is_constant);
    double worst_m = 0.0;
    for (std::size_t j = 0; j < joins.size(); ++j) {
      graph.off_m[j] = off_m_of(joins[j], keyframes);
      if (graph.is_used[j]) worst_m = std::max(worst_m, graph.off_m[j]);
    }
    if (worst_m <= config.max_off_m) return;
    for (std::size_t j = 0; j < joins.size(); ++j)
      if (graph.off_m[j] > std::max(config.max_off_m, 0.7 * worst_m)) graph.is_used[j] = false;
  }
}

double moved_m(std::span<const Eigen::Isometry3d> from, std::span<const Eigen::Isometry3d> to) {
  double most_m = 0.0;
  for (std::size_t k = 0; k < from.size(); ++k)
    most_m = std::max(most_m, motion_length_m(from[k].inverse() * to[k]));
  return most_m;
}

}  // namespace

BuildingGraph solve_building(std::span<const GraphSubmap> submaps, std::span<const GraphJoin> joins,
                             const TestOverlap& test_overlap, const GraphConfig& config) {
  BuildingGraph graph;
  graph.submaps.resize(submaps.size());
  graph.is_used = choose_joins(submaps, joins, test_overlap);
  graph.off_m.assign(joins.size(), 0.0);
  if (submaps.empty()) return graph;

  std::vector<Eigen::Isometry3d> T_building_submap;
  std::vector<std::size_t> part;
  JoinTree(submaps, joins, graph.is_used).place(T_building_submap, part);
  graph.parts = 1 + *std::max_element(part.begin(), part.end());

  // Each part begins at an earlier pose, if one of its submaps has one.
  const auto has_earlier = [&](std::size_t s) {
    return !submaps[s].T_building_keyframe.empty() &&
           submaps[s].T_building_keyframe.size() == submaps[s].T_submap_keyframe.size();
  };
  std::vector<std::optional<std::size_t>> root(graph.parts);  // a submap, by part
  for (const bool with_earlier : {true, false})
    for (std::size_t s = 0; s < submaps.size(); ++s)
      if (!root[part[s]] && has_earlier(s) == with_earlier && !submaps[s].T_submap_keyframe.empty())
        root[part[s]] = s;
  for (std::size_t p = 0; p < graph.parts; ++p) {
    if (!root[p] || !has_earlier(*root[p])) continue;
    const Eigen::Isometry3d T_now_before =
        submaps[*root[p]].T_building_keyframe.front() *
        (T_building_submap[*root[p]] * submaps[*root[p]].T_submap_keyframe.front()).inverse();
    for (std::size_t s = 0; s < submaps.size(); ++s)
      if (part[s] == p) T_building_submap[s] = T_now_before * T_building_submap[s];
  }

  Keyframes keyframes(submaps, T_building_submap);
  std::vector<bool> is_constant(keyframes.poses.size(), false);
  for (const auto& at : root)
    if (at) is_constant[keyframes.index(*at, 0)] = true;
  solve(submaps, joins, is_constant, config, keyframes, graph);

  // Submaps that hardly moved keep their earlier poses, so that what was fused with these stays valid.
  bool keeps_some = false;
  for (std::size_t s = 0; s < submaps.size(); ++s) {
    if (!has_earlier(s) || moved_m(submaps[s].T_building_keyframe, keyframes.of(s)) > config.keep_m) continue;
    graph.submaps[s].was_kept = keeps_some = true;
    for (std::size_t k = 0; k < submaps[s].T_building_keyframe.size(); ++k) {
      keyframes.poses[keyframes.index(s, k)] = submaps[s].T_building_keyframe[k];
      is_constant[keyframes.index(s, k)] = true;
    }
  }
  if (keeps_some) solve(submaps, joins, is_constant, config, keyframes, graph);

  for (std::size_t s = 0; s < submaps.size(); ++s) {
    const auto poses = keyframes.of(s);
    graph.submaps[s].T_building_keyframe.assign(poses.begin(), poses.end());
    graph.submaps[s].part = part[s];
  }
  return graph;
}

}  // namespace roomradar
