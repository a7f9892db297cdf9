// keyframe_job.cpp: background processing of a new keyframe: description, place recognition, graph edges.
#include "mapping/odometry/keyframe_job.hpp"

#include <span>
#include <utility>

#include "mapping/localization/place_matching.hpp"
#include "mapping/localization/relocalise.hpp"

namespace roomradar {
namespace {

/// Connects the newest keyframe to distant ones that look alike; returns whether any was connected.
bool join_alike(KeyframeGraph& graph, const MapKeyframe& newest, const KeyframeDatabase& keyframe_database,
                const ConnectConfig& config, KeyframeCache& cache) {
  constexpr int kMinMatches = 25, kMinInliers = 30;
  constexpr std::size_t kCandidates = 2;
  const std::size_t number = graph.keyframes.size() - 1;
  bool joined = false;
  const auto is_distant = [&](std::size_t i) {
    return view_distance(graph.keyframes[i].T_world_camera.inverse() *
                         graph.keyframes[number].T_world_camera) >= config.graph.furthest;
  };
  for (const std::size_t i : most_alike(newest, keyframe_database, kCandidates, kMinMatches, is_distant)) {
    const KeyframeMatch match = match_keyframes(keyframe_database.keyframes[i], newest);
    if (match.inliers < kMinInliers) continue;
    joined = join(graph, i, number, match.T_a_b, config, cache) || joined;
  }
  return joined;
}

}  // namespace

KeyframeJobResult run(KeyframeJob job, const KeyframeJobConfig& config) {
  KeyframeJobResult result;
  KeyframeGraph& graph = job.graph;
  result.place = make_map_keyframe(job.frame, graph.keyframes.back().T_world_camera, config.place);
  const bool came_back = join_alike(graph, result.place, *job.keyframe_database, config.join, job.cache);
  connect_newest(graph, config.join, job.cache);
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
