// keyframe_job.cpp: background processing of a new keyframe: description, place recognition, graph edges.
#include "mapping/odometry/keyframe_job.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

/// Connects the newest keyframe to distant ones that look alike; returns true if any was connected.
bool join_alike(KeyframeGraph& graph, const MapKeyframe& newest, const KeyframeDatabase& keyframe_database,
                const ConnectConfig& config, KeyframeCache& cache) {
  constexpr int kMinMatches = 25, kMinInliers = 30;
  constexpr std::size_t kCandidates = 2;
  const std::size_t number = graph.keyframes.size() - 1;
  bool joined = false;
  const auto is_distant = [&](std::size_t i) {
    return graph.keyframes[i].part == graph.keyframes[number].part &&
           view_distance(graph.keyframes[i].T_world_camera.inverse() *
                         graph.keyframes[number].T_world_camera) >= config.graph.furthest;
  };
  for (const std::size_t i : most_alike(newest, keyframe_database, kCandidates, kMinMatches, is_distant)) {
    const KeyframeMatch match = match_keyframes(keyframe_database.keyframes[i], newest);
    if (match.inliers < kMinInliers) continue;
    joined = join(graph, i, number, match.T_a_b, config, cache) || joined;
  }
  return joined;
}

/// Returns true if one of the constraints from `first` on contradicts the current poses: its residual is
/// above 5 standard deviations.
bool is_contradicted(const KeyframeGraph& graph, std::size_t first) {
  constexpr double kMaxSigma = 5.0;
  const auto is_contradiction = [&](const PoseConstraint& c) {
    const Eigen::Isometry3d T_a_b =
        graph.keyframes[c.a].T_world_camera.inverse() * graph.keyframes[c.b].T_world_camera;
    const Vector6d error = local(c.T_a_b.inverse() * T_a_b);
    return error.dot(c.information * error) > kMaxSigma * kMaxSigma;
  };
  return std::any_of(graph.constraints.begin() + static_cast<std::ptrdiff_t>(first), graph.constraints.end(),
                     is_contradiction);
}

}  // namespace

KeyframeJobResult run(KeyframeJob job, const KeyframeJobConfig& config) {
  KeyframeJobResult result;
  KeyframeGraph& graph = job.graph;
  result.place = make_map_keyframe(job.frame, graph.keyframes.back().T_world_camera, config.place);
  const std::size_t known_constraints = graph.constraints.size();
  const bool came_back = join_alike(graph, result.place, *job.keyframe_database, config.join, job.cache);
  const bool closes_loop = came_back && is_contradicted(graph, known_constraints);
  connect_newest(graph, config.join, job.cache);
  connect_flow(graph, graph.keyframes.size() - 1);
  connect_recorded(graph, graph.keyframes.size() - 1);
  if (closes_loop) {
    solve(graph);
  } else {
    solve_near_newest(graph, config.join.graph.furthest);
  }
  if (job.known != nullptr) {
    const Relocalisation found = relocalise(job.frame, *job.known, config.relocalise);
    if (found) result.T_known_camera = found.T_world_camera;
  }
  result.graph = std::move(graph);
  return result;
}

}  // namespace roomradar
