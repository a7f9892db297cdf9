// keyframe_job.cpp: background processing of a new keyframe: description, place recognition, graph edges.
#include "mapping/odometry/keyframe_job.hpp"

#include <span>
#include <utility>

#include "mapping/localization/place_matching.hpp"

namespace roomradar {
namespace {

/// Connects the newest keyframe to distant ones that look alike; returns whether any was connected.
bool join_alike(KeyframeGraph& graph, const Place& newest, const Places& places, const JoinConfig& config,
                WarmKeyframes& warm) {
  constexpr int kMinMatches = 25, kMinInliers = 30;
  constexpr std::size_t kCandidates = 2;
  const std::size_t number = graph.keyframes.size() - 1;
  bool joined = false;
  for (const std::size_t i : most_alike(newest, places.keyframes, kCandidates, kMinMatches)) {
    const Eigen::Isometry3d T_older_newest =
        graph.keyframes[i].T_world_camera.inverse() * graph.keyframes[number].T_world_camera;
    if (view_distance(T_older_newest) < config.graph.furthest) continue;
    const PlaceMatch match = match_places(places.keyframes[i], newest);
    if (match.inliers < kMinInliers) continue;
    joined = join(graph, i, number, match.T_a_b, config, warm) || joined;
  }
  return joined;
}

}  // namespace

KeyframeJobResult run(KeyframeJob job, const KeyframeJobConfig& config) {
  KeyframeJobResult result;
  KeyframeGraph& graph = job.graph;
  result.place = describe_place(job.frame, graph.keyframes.back().T_world_camera, config.place);
  const bool came_back = join_alike(graph, result.place, *job.places, config.join, job.warm);
  join_newest(graph, config.join, job.warm);
  if (came_back) {
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
