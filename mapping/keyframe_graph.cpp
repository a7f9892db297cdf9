// keyframe_graph.cpp: joining keyframes that see the same, and solving for their poses.
#include "mapping/keyframe_graph.hpp"

#include <algorithm>
#include <array>
#include <future>
#include <numbers>
#include <optional>
#include <utility>

namespace roomradar {
namespace {

constexpr std::size_t kNeighbours = 3;  // keyframes closer in number than this are neighbours, not loops

bool is_joint(const Tracking& t, const KeyframeGraphConfig& config) {
  return (t.status == TrackStatus::kTracked || t.status == TrackStatus::kDegenerate) &&
         t.overlap >= config.min_overlap && t.inlier_fraction >= config.min_inliers;
}

/// `count` of the items, evenly spread from the first to the last.
std::vector<std::size_t> spread(const std::vector<std::size_t>& items, std::size_t count) {
  if (items.size() <= count) return items;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(items[i * items.size() / count]);
  return chosen;
}

/// Both constraints between two keyframes, if they can be joined.
std::optional<std::array<PoseConstraint, 2>> joint(const KeyframeGraph& graph, std::size_t older,
                                                   std::size_t newer, const Eigen::Isometry3d& T_older_newer,
                                                   const JoinConfig& config, WarmKeyframes& warm) {
  const auto a = warm.get(older, *graph.keyframes[older].view, config.view);
  const auto b = warm.get(newer, *graph.keyframes[newer].view, config.view);
  const Tracking b_in_a = align(b->live, a->reference, T_older_newer, config.align);
  if (!is_joint(b_in_a, config.graph)) return std::nullopt;
  const Tracking a_in_b = align(a->live, b->reference, T_older_newer.inverse(), config.align);
  const Eigen::Isometry3d gap = b_in_a.T_world_camera * a_in_b.T_world_camera;
  if (!is_joint(a_in_b, config.graph) || gap.translation().norm() > config.graph.max_gap_m ||
      Eigen::AngleAxisd(gap.linear()).angle() > config.graph.max_gap_rad ||
      !is_within_drift(graph, older, newer, b_in_a.T_world_camera, config.graph)) {
    return std::nullopt;
  }
  const bool loop = newer - older >= kNeighbours;
  return std::array<PoseConstraint, 2>{
      PoseConstraint{older, newer, b_in_a.T_world_camera, b_in_a.information, loop},
      PoseConstraint{newer, older, a_in_b.T_world_camera, a_in_b.information, loop}};
}

/// Joins one keyframe with at most `most` older ones; constraints and counts are added to `found`.
void join_older(const KeyframeGraph& graph, std::size_t newer, int most, const JoinConfig& config,
                WarmKeyframes& warm, KeyframeGraph& found) {
  const Eigen::Isometry3d T_world_newer = graph.keyframes[newer].T_world_camera;
  std::vector<std::size_t> older = keyframes_near(graph, T_world_newer, config.graph.furthest);
  std::erase_if(older, [&](std::size_t i) { return i >= newer; });
  for (const std::size_t i : spread(older, static_cast<std::size_t>(std::max(most, 1)))) {
    const auto pair =
        joint(graph, i, newer, graph.keyframes[i].T_world_camera.inverse() * T_world_newer, config, warm);
    if (pair) found.constraints.insert(found.constraints.end(), pair->begin(), pair->end());
    if (newer - i >= kNeighbours) ++(pair ? found.loops_found : found.loops_rejected);
  }
}

void take(KeyframeGraph& graph, const KeyframeGraph& found) {
  graph.constraints.insert(graph.constraints.end(), found.constraints.begin(), found.constraints.end());
  graph.loops_found += found.loops_found;
  graph.loops_rejected += found.loops_rejected;
}

void solve_free(KeyframeGraph& graph, const std::vector<bool>& held) {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(graph.keyframes.size());
  for (const Keyframe& keyframe : graph.keyframes) poses.push_back(keyframe.T_world_camera);
  if (!is_usable(optimise_pose_graph(poses, graph.constraints, graph.anchors, held).status)) return;
  for (std::size_t i = 0; i < poses.size(); ++i) graph.keyframes[i].T_world_camera = poses[i];
}

}  // namespace

double view_distance(const Eigen::Isometry3d& T_a_b) {
  constexpr double kFar_m = 0.8, kFar_rad = 35.0 * std::numbers::pi / 180.0;
  return T_a_b.translation().norm() / kFar_m + Eigen::AngleAxisd(T_a_b.linear()).angle() / kFar_rad;
}

std::vector<std::size_t> keyframes_near(const KeyframeGraph& graph, const Eigen::Isometry3d& T_world_camera,
                                        double furthest) {
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) {
    const double distance = view_distance(graph.keyframes[i].T_world_camera.inverse() * T_world_camera);
    if (distance < furthest) found.emplace_back(distance, i);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> near;
  near.reserve(found.size());
  for (const auto& [distance, i] : found) near.push_back(i);
  return near;
}

bool is_within_drift(const KeyframeGraph& graph, std::size_t older, std::size_t newer,
                     const Eigen::Isometry3d& T_older_newer, const KeyframeGraphConfig& config) {
  const Keyframe& a = graph.keyframes[older];
  const Keyframe& b = graph.keyframes[newer];
  const Eigen::Isometry3d change = (a.T_world_camera.inverse() * b.T_world_camera).inverse() * T_older_newer;
  const double most = config.drift_m + config.drift_part * std::abs(b.way_m - a.way_m);
  return change.translation().norm() < most && Eigen::AngleAxisd(change.linear()).angle() < most;
}

bool join(KeyframeGraph& graph, std::size_t older, std::size_t newer, const Eigen::Isometry3d& T_older_newer,
          const JoinConfig& config, WarmKeyframes& warm) {
  const auto pair = joint(graph, older, newer, T_older_newer, config, warm);
  if (pair) graph.constraints.insert(graph.constraints.end(), pair->begin(), pair->end());
  if (newer - older >= kNeighbours) ++(pair ? graph.loops_found : graph.loops_rejected);
  return pair.has_value();
}

void join_newest(KeyframeGraph& graph, const JoinConfig& config, WarmKeyframes& warm) {
  if (graph.keyframes.size() < 2) return;
  KeyframeGraph found;
  join_older(graph, graph.keyframes.size() - 1, config.graph.joins_at_once, config, warm, found);
  take(graph, found);
}

void join_all(KeyframeGraph& graph, const JoinConfig& config) {
  graph.constraints.clear();
  graph.loops_found = graph.loops_rejected = 0;
  const auto join_range = [&](std::size_t begin, std::size_t end) {
    WarmKeyframes warm(config.graph.warm);
    KeyframeGraph found;
    for (std::size_t newer = begin; newer < end; ++newer) {
      join_older(graph, newer, config.graph.joins, config, warm, found);
    }
    return found;
  };
  // Later keyframes have more older ones to be joined with.
  const std::size_t count = graph.keyframes.size(), middle = count * 6 / 10;
  auto later = std::async(std::launch::async, join_range, std::max<std::size_t>(middle, 1), count);
  const KeyframeGraph first = join_range(1, middle);
  take(graph, first);
  take(graph, later.get());
}

void solve(KeyframeGraph& graph) {
  std::vector<bool> held(graph.keyframes.size(), false);
  if (!held.empty() && graph.anchors.empty()) held.front() = true;
  solve_free(graph, held);
}

void solve_near_newest(KeyframeGraph& graph, double furthest) {
  if (graph.keyframes.size() < 2) return;
  std::vector<bool> held(graph.keyframes.size(), true);
  for (const std::size_t i : keyframes_near(graph, graph.keyframes.back().T_world_camera, furthest))
    held[i] = false;
  if (graph.anchors.empty()) held.front() = true;
  solve_free(graph, held);
}

}  // namespace roomradar
