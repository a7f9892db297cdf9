// odometry.cpp: tracks a camera in an unknown room with keyframes and loop closure.
#include "mapping/odometry/odometry.hpp"

#include <algorithm>
#include <utility>

#include "mapping/alignment/packed_view.hpp"
#include "mapping/alignment/stationary_camera.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/odometry_state.hpp"

namespace roomradar {
Tracking Odometry::State::start(const Frame& frame) {
  Tracking tracking;
  if (live.levels.front().size() < static_cast<std::size_t>(std::max(config.align.min_points, 1))) {
    tracking.status = TrackStatus::kTooFewPoints;
    return tracking;
  }
  tracking.status = TrackStatus::kTracked;
  tracking.overlap = tracking.inlier_fraction = 1.0;
  add_keyframe(frame, tracking);
  return tracking;
}

/// Aligns the frame with a keyframe and its neighbours; prepares at most one neighbour that is not cached.
Tracking Odometry::State::align_near(std::size_t first, const Eigen::Isometry3d& T_world_guess) {
  // Max view_distance(); beyond it the frame overlaps the keyframe too little.
  constexpr double kUsefulReference = 0.7;
  const auto most = static_cast<std::size_t>(std::max(config.references, 1));
  const std::vector<Keyframe>& keyframes = kept.graph.keyframes;
  std::vector<std::shared_ptr<const CachedKeyframe>> used{
      cache.get(first, *keyframes[first].view, config.view)};
  std::vector<PosedReference> references{{&used[0]->reference, keyframes[first].T_world_camera}};
  bool made_one = false;
  for (const std::size_t i : keyframes_near(keyframes, T_world_guess, kUsefulReference)) {
    if (i == first || references.size() >= most) continue;
    auto other = cache.find(i);
    if (!other && std::exchange(made_one, true)) continue;
    if (!other) other = cache.get(i, *keyframes[i].view, config.view);
    references.push_back({&other->reference, keyframes[i].T_world_camera});
    used.push_back(std::move(other));
  }
  return align(live, references, T_world_guess, config.align, readout);
}

/// Tracks the frame from the predicted pose, or recovers.
Tracking Odometry::State::find_pose(const Frame& frame, const PredictedMotion& predicted) {
  readout = {kept.T_world_last, predicted.dt_s, kept.timing.current.depth_readout_s};
  Tracking tracking = align_near(kept.current, predicted.T_world_camera);
  if (is_plausible(tracking, predicted.T_world_camera)) {
    velocity = velocity_of(kept.T_world_last.inverse() * tracking.T_world_camera, predicted.dt_s);
    return tracking;
  }
  readout = {};
  velocity = {};
  return recover(frame);
}

Tracking Odometry::State::recover(const Frame& frame) {
  Tracking standing = align_near(kept.current, kept.T_world_last);
  if (standing && is_plausible(standing, kept.T_world_last)) return standing;
  standing.status = TrackStatus::kDiverged;
  if (frame.colour.empty() && !kept.last_moved_grey.empty())
    return standing;  // this frame alone has lost its colour
  const Relocalisation found = relocalise(frame, kept.keyframe_database, config.relocalise);
  if (!found) return standing;
  const auto keyframe = static_cast<std::size_t>(found.keyframe);
  const Tracking tracking = align_near(keyframe, found.T_world_camera);
  if (!tracking) return standing;
  ++kept.counts.relocalised;
  take_up(keyframe);
  // The jump from the last pose is not a motion to predict from.
  kept.T_world_last = tracking.T_world_camera;
  return tracking;
}

/// Limits the change of motion between frames to that of a hand. A recalibrating sensor seems to exceed it.
/// The first motion may turn more, because no motion is known before it.
bool Odometry::State::is_plausible(const Tracking& tracking,
                                   const Eigen::Isometry3d& T_world_expected) const {
  constexpr double kMost_m = 0.10, kMost_rad = 0.10, kMostAtFirst_rad = 0.15;
  if (!has_pose(tracking)) return false;
  const Eigen::Isometry3d change = T_world_expected.inverse() * tracking.T_world_camera;
  return change.translation().norm() < kMost_m &&
         Eigen::AngleAxisd(change.linear()).angle() < (kept.frames.size() < 2 ? kMostAtFirst_rad : kMost_rad);
}

/// Adds the aligned frame's evidence on the sensor's times.
void Odometry::State::take_evidence(const Frame& frame, const Tracking& tracking) {
  const CameraVelocity steady = mean_velocity(kept, tracking.T_world_camera, frame.stamp_s);
  const Keyframe& keyframe = kept.graph.keyframes[kept.current];
  const auto used = cache.get(kept.current, *keyframe.view, config.view);
  add_evidence(kept.timing,
               timing_evidence(
                   live, {tracking.T_world_camera, velocity, steady, kept.timing.current}, used->reference,
                   {keyframe.T_world_camera, keyframe.velocity, keyframe.steady_velocity, keyframe.timing}));
}

Odometry::Odometry(const OdometryConfig& config) : state_(std::make_unique<State>(config)) {}
Odometry::Odometry(Odometry&&) noexcept = default;
Odometry& Odometry::operator=(Odometry&&) noexcept = default;
Odometry::~Odometry() = default;

Odometry::Odometry(const OdometryConfig& config, OdometrySnapshot snapshot)
    : state_(std::make_unique<State>(config)) {
  state_->kept = std::move(snapshot);
  update_index(state_->kept.keyframe_database);
  if (state_->kept.graph.keyframes.empty()) return;
  StoredView view = unpacked(*state_->kept.graph.keyframes[state_->kept.current].view);
  restore(view, config.view, state_->open);
  state_->open_measured = std::move(view.measured);
}

void Odometry::set_prior_map(KeyframeDatabase known) {
  state_->known = std::move(known);
  update_index(state_->known);
}

const OdometrySnapshot& Odometry::state() const { return state_->kept; }

Tracking Odometry::track(const Frame& frame) {
  State& s = *state_;
  OdometrySnapshot& kept = s.kept;
  ++kept.counts.frames;
  const bool first = kept.graph.keyframes.empty();
  if (kept.counts.frames == 1) kept.timing = start_estimate(s.config.timing.value_or(frame.timing));
  const PredictedMotion predicted = predict(kept, frame.stamp_s);
  make_pyramid(frame, s.config.view, s.pyramid, {predicted.velocity, kept.timing.current});
  make_source_points(s.pyramid, s.live);
  const bool is_joining = s.job.valid() || s.joined;
  if (is_joining && ++s.job_frames >= s.config.apply_result_after_frames) s.take_over_job();
  if (!first && is_camera_stationary(kept.last_moved_grey, s.pyramid.grey)) {
    ++kept.counts.tracked;
    kept.T_world_last = kept.last_moved.T_world_camera;
    kept.T_last_next.setIdentity();
    keep(kept, frame, kept.last_moved);
    return kept.last_moved;
  }
  Tracking tracking = first ? s.start(frame) : s.find_pose(frame, predicted);
  const bool second = !first && kept.graph.keyframes.size() == 1 && !kept.frames.empty() &&
                      kept.graph.keyframes.front().frame_index == kept.frames.back().frame_index;
  if (tracking && second) {
    s.remake_first_keyframe();
    make_pyramid(frame, s.config.view, s.pyramid, {s.velocity, kept.timing.current});
    make_source_points(s.pyramid, s.live);
    tracking = s.find_pose(frame, {tracking.T_world_camera, s.velocity, predicted.dt_s});
  }
  if (!has_pose(tracking)) {
    ++kept.counts.lost;
    tracking.T_world_camera = kept.T_world_last;
    kept.T_last_next.setIdentity();
    keep(kept, frame, tracking);
    return tracking;
  }
  const Eigen::Isometry3d T_last_next = kept.T_world_last.inverse() * tracking.T_world_camera;
  kept.path_length_m += motion_length_m(T_last_next) * (tracking ? 1.0 : 10.0);
  if (tracking && !first) {
    // The first keyframe was made with the velocity of one pair of frames.
    if (s.config.estimate_timing && kept.current > 0) s.take_evidence(frame, tracking);
    deskew(s.pyramid, s.velocity, kept.timing.current.depth_readout_s);
    s.improve_current(tracking);
    s.choose_keyframe(frame, tracking);
  }
  ++(tracking ? kept.counts.tracked : kept.counts.degenerate);
  kept.T_last_next = expected_motion(tracking, T_last_next);
  kept.T_world_last = tracking.T_world_camera;
  kept.last_moved_grey.resize(0, 0);
  if (tracking) {
    kept.last_moved_grey = s.pyramid.grey;
    kept.last_moved = tracking;
  }
  keep(kept, frame, tracking);
  return tracking;
}

void Odometry::add_posed(const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  roomradar::add_posed(state_->kept, frame, T_world_camera, state_->config);
}

void Odometry::finish_jobs() {
  state_->wait_for_job();
  state_->store_open();
}

OdometrySnapshot Odometry::snapshot() const {
  OdometrySnapshot snapshot = state_->kept;
  if (state_->joined) take_over(*state_->joined, snapshot);
  return snapshot;
}

std::vector<TrackedFrame> Odometry::optimise() {
  State& s = *state_;
  s.take_over_job();
  s.store_open();
  s.kept.keyframe_database.index = {};  // only tracking needs it, and would build it again
  if (!s.kept.graph.keyframes.empty()) {
    KeyframeGraph graph = s.kept.graph;
    s.cache = KeyframeCache(s.config.graph.cached_keyframes);  // no longer needed, and large
    close_loops(graph, s.pairs.finish(), job_config(s.config).join);
    solve_positions_then_turns(graph);
    move_keyframes(graph.keyframes, s.kept);
    graph.keyframes = s.kept.graph.keyframes;
    s.kept.graph = std::move(graph);
  }
  return trajectory_of(s.kept);
}

KeyframeDatabase Odometry::take_keyframe_database() {
  state_->take_over_job();
  return std::exchange(state_->kept.keyframe_database, {});
}

OdometryCounts Odometry::counts() const {
  OdometryCounts counts = state_->kept.counts;
  counts.loops_found = state_->kept.graph.loops_found;
  counts.loops_rejected = state_->kept.graph.loops_rejected;
  return counts;
}

}  // namespace roomradar
