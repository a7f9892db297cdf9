// keyframe_graph.cpp: connects keyframes with overlapping views, and optimises their poses.
#include "mapping/odometry/keyframe_graph.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "mapping/alignment/motion_prior.hpp"
#include "mapping/localization/pose_hypothesis.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr std::size_t kNeighbours = 3;  // keyframes closer in sequence than this are neighbours, not loops

bool is_joint(const Tracking& t, const KeyframeGraphConfig& config) {
  return has_pose(t) && t.overlap >= config.min_overlap && t.inlier_fraction >= config.min_inliers;
}

/// Returns `count` of the items, evenly spread.
std::vector<std::size_t> spread(const std::vector<std::size_t>& items, std::size_t count) {
  if (items.size() <= count) return items;
  std::vector<std::size_t> chosen;
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(items[i * items.size() / count]);
  return chosen;
}

Eigen::Isometry3d relative(const KeyframeGraph& graph, std::size_t a, std::size_t b) {
  return graph.keyframes[a].T_world_camera.inverse() * graph.keyframes[b].T_world_camera;
}

void solve_free(KeyframeGraph& graph, const std::vector<PoseConstraint>& constraints,
                const std::vector<PoseAnchor>& anchors, const std::vector<bool>& constant) {
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(graph.keyframes.size());
  for (const Keyframe& keyframe : graph.keyframes) poses.push_back(keyframe.T_world_camera);
  if (!is_usable(optimise_pose_graph(poses, constraints, anchors, constant).status)) return;
  for (std::size_t i = 0; i < poses.size(); ++i) graph.keyframes[i].T_world_camera = poses[i];
}

/// Holds the first pose of each part constant, unless anchors locate the part in the world.
void hold_first_of_parts(const KeyframeGraph& graph, const std::vector<PoseAnchor>& anchors,
                         std::vector<bool>& constant) {
  std::map<int, bool> is_held;  // by part
  for (const PoseAnchor& anchor : anchors) is_held[graph.keyframes[anchor.pose].part] = true;
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i) {
    if (!std::exchange(is_held[graph.keyframes[i].part], true)) constant[i] = true;
  }
}

std::vector<bool> first_constant(const KeyframeGraph& graph, const std::vector<PoseAnchor>& anchors) {
  std::vector<bool> constant(graph.keyframes.size(), false);
  hold_first_of_parts(graph, anchors, constant);
  return constant;
}

/// Reweights a constraint by the similarity of its keyframes' views, in all directions in which it has
/// information.
PoseConstraint weighed_by_likeness(PoseConstraint constraint) {
  // Chosen on the kitchen recording, together with OdometryConfig::align_keyframes: ATE fell from 24.4 to
  // 21.9 mm, RPE over 30 frames from 17.9 to 16.7 mm.
  constexpr double kSigma_m = 0.02, kSigma_rad = 0.063;  // for two identical viewpoints
  constexpr double kAlike = 0.3;                         // view_distance() at which the weight is halved
  constexpr double kNothing = 1e-9;                      // relative to the strongest direction
  if (constraint.recorded) return constraint;
  const double distance = view_distance(constraint.T_a_b) / kAlike;
  const double weight = 1.0 / (1.0 + distance * distance * distance * distance);
  const SymmetricEigen<6> known = symmetric_eigen(constraint.information);
  if (!constraint.information.allFinite() || !known.converged) return constraint;
  Matrix6d says = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i) {
    if (known.values(i) > kNothing * known.values(5))
      says += known.vectors.col(i) * known.vectors.col(i).transpose();
  }
  Matrix6d worth = Matrix6d::Zero();
  worth.diagonal().head<3>().setConstant(weight / (kSigma_m * kSigma_m));
  worth.diagonal().tail<3>().setConstant(weight / (kSigma_rad * kSigma_rad));
  constraint.information = says * worth * says;
  return constraint;
}

}  // namespace

bool agrees(const PoseAnchor& anchor, const Keyframe& keyframe, const Eigen::Isometry3d& T_known_world) {
  constexpr double kNear_m = 0.15, kNear_rad = 0.1;
  return is_near(anchor.T_world_camera, T_known_world * keyframe.T_world_camera, kNear_m, kNear_rad);
}

std::vector<PoseAnchor> agreeing_anchors(const KeyframeGraph& graph) {
  std::vector<PoseAnchor> agreeing;
  std::copy_if(graph.anchors.begin(), graph.anchors.end(), std::back_inserter(agreeing),
               [&](const PoseAnchor& anchor) {
                 return agrees(anchor, graph.keyframes[anchor.pose], Eigen::Isometry3d::Identity());
               });
  return agreeing;
}

std::vector<std::size_t> keyframes_near(std::span<const Keyframe> keyframes,
                                        const Eigen::Isometry3d& T_world_camera, double furthest, int part) {
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (keyframes[i].part != part) continue;
    const double distance = view_distance(keyframes[i].T_world_camera.inverse() * T_world_camera);
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
  const double path_m = std::abs(b.path_length_m - a.path_length_m);
  const double most_m = config.drift_m + config.drift_part * path_m;
  const double most_rad = config.drift_rad + config.drift_rad_per_m * path_m;
  return change.translation().norm() < most_m && Eigen::AngleAxisd(change.linear()).angle() < most_rad;
}

bool add_constraints(KeyframeGraph& graph, const KeyframePair& pair, const KeyframeGraphConfig& config) {
  const auto& [older, newer, newer_in_older, older_in_newer] = pair;
  const Eigen::Isometry3d gap = newer_in_older.T_world_camera * older_in_newer.T_world_camera;
  const bool agree = is_joint(newer_in_older, config) && is_joint(older_in_newer, config) &&
                     gap.translation().norm() <= config.max_gap_m &&
                     Eigen::AngleAxisd(gap.linear()).angle() <= config.max_gap_rad &&
                     is_within_drift(graph, older, newer, newer_in_older.T_world_camera, config);
  const bool loop = newer - older >= kNeighbours;
  if (loop) ++(agree ? graph.loops_found : graph.loops_rejected);
  if (!agree) return false;
  // Systematic errors of alignments count once recorded poses compete with them.
  const bool is_weak_pair = graph.keyframes[older].is_by_flow || graph.keyframes[newer].is_by_flow;
  const auto information = [&](const Tracking& t) {
    if (is_weak_pair) return limited_information(t.clear_information);
    return graph.recorded_sigma_m > 0.0 ? limited_information(t.information) : t.information;
  };
  graph.constraints.push_back(
      {older, newer, newer_in_older.T_world_camera, information(newer_in_older), loop, false});
  graph.constraints.push_back(
      {newer, older, older_in_newer.T_world_camera, information(older_in_newer), loop, false});
  return true;
}

bool join(KeyframeGraph& graph, std::size_t older, std::size_t newer, const Eigen::Isometry3d& T_older_newer,
          const ConnectConfig& config, KeyframeCache& cache) {
  // `older` is not cached: it is rarely used again, and would stay in memory until the cache evicts it.
  std::shared_ptr<const CachedKeyframe> a = cache.find(older);
  if (!a) a = prepare_keyframe(*graph.keyframes[older].view, config.view);
  const auto b = cache.get(newer, *graph.keyframes[newer].view, config.view);
  return add_constraints(graph,
                         {older, newer, align(b->live, a->reference, T_older_newer, config.align),
                          align(a->live, b->reference, T_older_newer.inverse(), config.align)},
                         config.graph);
}

void connect_newest(KeyframeGraph& graph, const ConnectConfig& config, KeyframeCache& cache) {
  if (graph.keyframes.size() < 2) return;
  const std::size_t newest = graph.keyframes.size() - 1;
  const std::vector<std::size_t> near =
      keyframes_near(std::span(graph.keyframes).first(newest), graph.keyframes[newest].T_world_camera,
                     config.graph.furthest, graph.keyframes[newest].part);
  for (const std::size_t i : spread(near, static_cast<std::size_t>(std::max(config.graph.max_edges_new, 1))))
    join(graph, i, newest, relative(graph, i, newest), config, cache);
}

void connect_flow(KeyframeGraph& graph, std::size_t keyframe) {
  constexpr double kSigma_m = 0.01, kSigma_rad = 0.004;
  if (keyframe == 0 || keyframe >= graph.keyframes.size()) return;
  const Keyframe &a = graph.keyframes[keyframe - 1], &b = graph.keyframes[keyframe];
  if (a.part != b.part || !(a.is_by_flow || b.is_by_flow)) return;
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 / (kSigma_m * kSigma_m));
  information.diagonal().tail<3>().setConstant(1.0 / (kSigma_rad * kSigma_rad));
  graph.constraints.push_back(
      {keyframe - 1, keyframe, a.T_world_camera.inverse() * b.T_world_camera, information, false, true});
}

void connect_recorded(KeyframeGraph& graph, std::size_t keyframe) {
  if (keyframe == 0 || keyframe >= graph.keyframes.size()) return;
  const Keyframe &a = graph.keyframes[keyframe - 1], &b = graph.keyframes[keyframe];
  if (!a.T_recorded_camera || !b.T_recorded_camera || a.stretch != b.stretch) return;
  const Eigen::Isometry3d T_a_b = a.T_recorded_camera->inverse() * *b.T_recorded_camera;
  graph.constraints.push_back(
      {keyframe - 1, keyframe, T_a_b, prior_information(graph.recorded_sigma_m, T_a_b), true, true});
}

void solve(KeyframeGraph& graph) {
  const std::vector<PoseAnchor> anchors = agreeing_anchors(graph);
  solve_free(graph, graph.constraints, anchors, first_constant(graph, anchors));
}

void solve_positions_then_turns(KeyframeGraph& graph) {
  if (graph.keyframes.empty()) return;
  const Eigen::Isometry3d T_world_first = graph.keyframes.front().T_world_camera;
  std::vector<PoseConstraint> weighed;
  weighed.reserve(graph.constraints.size());
  for (const PoseConstraint& constraint : graph.constraints)
    weighed.push_back(weighed_by_likeness(constraint));
  const std::vector<PoseAnchor> known = agreeing_anchors(graph);
  solve_free(graph, weighed, known, first_constant(graph, known));

  // No pose is constant now: a constant first pose would keep its rotation from the first step.
  constexpr double kSigma_m = 1e-4;  // not 0: many consistent alignments may still move a position
  Matrix6d position = Matrix6d::Zero();
  position.diagonal().head<3>().setConstant(1.0 / (kSigma_m * kSigma_m));
  std::vector<PoseAnchor> anchors = known;
  for (std::size_t i = 0; i < graph.keyframes.size(); ++i)
    anchors.push_back({i, graph.keyframes[i].T_world_camera, position});
  const std::vector<bool> none_constant(graph.keyframes.size(), false);
  solve_free(graph, graph.constraints, anchors, none_constant);
  if (!known.empty()) return;
  const Eigen::Isometry3d T_before_after = T_world_first * graph.keyframes.front().T_world_camera.inverse();
  for (Keyframe& keyframe : graph.keyframes)
    keyframe.T_world_camera = T_before_after * keyframe.T_world_camera;
}

void solve_near_newest(KeyframeGraph& graph, double furthest) {
  if (graph.keyframes.size() < 2) return;
  std::vector<bool> constant(graph.keyframes.size(), true);
  for (const std::size_t i : keyframes_near(graph.keyframes, graph.keyframes.back().T_world_camera, furthest,
                                            graph.keyframes.back().part))
    constant[i] = false;
  const std::vector<PoseAnchor> anchors = agreeing_anchors(graph);
  hold_first_of_parts(graph, anchors, constant);
  solve_free(graph, graph.constraints, anchors, constant);
}

}  // namespace roomradar
