// keyframe_graph.cpp: joining keyframes that see the same, and solving for their poses.
#include "mapping/keyframe_graph.hpp"

#include <algorithm>
#include <numbers>
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

void join_older(KeyframeGraph& graph, std::size_t newer, int most, const AlignConfig& align,
                const KeyframeGraphConfig& config) {
  const Eigen::Isometry3d T_world_newer = graph.keyframes[newer].reference.T_world_view;
  std::vector<std::size_t> older = keyframes_near(graph, T_world_newer, config.furthest);
  std::erase_if(older, [&](std::size_t i) { return i >= newer; });
  for (const std::size_t i : spread(older, static_cast<std::size_t>(std::max(most, 1)))) {
    join(graph, i, newer, graph.keyframes[i].reference.T_world_view.inverse() * T_world_newer, align, config);
  }
}

void solve(KeyframeGraph& graph) {
  std::vector<Eigen::Isometry3d> poses;
  for (const Keyframe& keyframe : graph.keyframes) poses.push_back(keyframe.reference.T_world_view);
  if (!optimise_pose_graph(poses, graph.constraints).usable) return;
  for (std::size_t i = 0; i < poses.size(); ++i) graph.keyframes[i].reference.T_world_view = poses[i];
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
    const double distance =
        view_distance(graph.keyframes[i].reference.T_world_view.inverse() * T_world_camera);
    if (distance < furthest) found.emplace_back(distance, i);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::size_t> near;
  near.reserve(found.size());
  for (const auto& [distance, i] : found) near.push_back(i);
  return near;
}

bool join(KeyframeGraph& graph, std::size_t older, std::size_t newer, const Eigen::Isometry3d& T_older_newer,
          const AlignConfig& align_config, const KeyframeGraphConfig& config) {
  const Keyframe& a = graph.keyframes[older];
  const Keyframe& b = graph.keyframes[newer];
  const bool loop = newer - older >= kNeighbours;
  LiveView live_a, live_b;
  make_live(a.pyramid, live_a);
  make_live(b.pyramid, live_b);
  const Eigen::Isometry3d& T_world_a = a.reference.T_world_view;
  const Eigen::Isometry3d& T_world_b = b.reference.T_world_view;
  const Tracking b_in_a = align(live_b, a.reference, T_world_a * T_older_newer, align_config);
  const Tracking a_in_b = align(live_a, b.reference, T_world_b * T_older_newer.inverse(), align_config);
  const Eigen::Isometry3d T_a_b = T_world_a.inverse() * b_in_a.T_world_camera;
  const Eigen::Isometry3d T_b_a = T_world_b.inverse() * a_in_b.T_world_camera;
  const Eigen::Isometry3d gap = T_a_b * T_b_a;
  if (!is_joint(b_in_a, config) || !is_joint(a_in_b, config) || gap.translation().norm() > config.max_gap_m ||
      Eigen::AngleAxisd(gap.linear()).angle() > config.max_gap_rad) {
    if (loop) ++graph.loops_rejected;
    return false;
  }
  graph.constraints.push_back({older, newer, T_a_b, b_in_a.information, loop});
  graph.constraints.push_back({newer, older, T_b_a, a_in_b.information, loop});
  if (loop) ++graph.loops_found;
  return true;
}

void join_newest(KeyframeGraph& graph, const AlignConfig& align_config, const KeyframeGraphConfig& config) {
  if (graph.keyframes.size() < 2) return;
  const std::size_t before = graph.constraints.size();
  join_older(graph, graph.keyframes.size() - 1, config.joins_at_once, align_config, config);
  if (graph.constraints.size() > before) solve(graph);
}

void join_all(KeyframeGraph& graph, const ViewConfig& view, const AlignConfig& align_config,
              const KeyframeGraphConfig& config) {
  for (Keyframe& keyframe : graph.keyframes) {
    if (keyframe.improved_since_refresh > 0) refresh(keyframe, view);
  }
  graph.constraints.clear();
  graph.loops_found = graph.loops_rejected = 0;
  for (std::size_t newer = 1; newer < graph.keyframes.size(); ++newer) {
    join_older(graph, newer, config.joins, align_config, config);
  }
  solve(graph);
}

}  // namespace roomradar
