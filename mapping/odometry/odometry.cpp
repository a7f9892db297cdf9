// odometry.cpp: tracks a camera in an unknown room with keyframes and loop closure.
#include "mapping/odometry/odometry.hpp"

#include <algorithm>
#include <future>
#include <numbers>
#include <optional>
#include <utility>

#include "mapping/alignment/stationary_camera.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/keyframe_job.hpp"
#include "mapping/odometry/keyframe_pairs.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"

namespace roomradar {
namespace {

/// Length of a motion; a radian counts as a metre.
double length(const Eigen::Isometry3d& T) {
  return T.translation().norm() + Eigen::AngleAxisd(T.linear()).angle();
}

KeyframeJobConfig job_config(const OdometryConfig& config) {
  return {{config.view, config.align_keyframes, config.graph}, config.place, config.relocalise};
}

}  // namespace

struct Odometry::State {
  OdometryConfig config;
  KeyframeDatabase known;
  OdometrySnapshot kept;
  ViewPyramid pyramid;  ///< of the current frame, like `live`
  SourcePoints live;
  KeyframeCache cache;
  ViewPyramid open;  ///< the current keyframe's, refined by the views since it became current
  Image<std::uint8_t> open_measured;
  bool open_is_newer = false;  ///< newer than the stored view
  std::future<KeyframeJobResult> job;
  std::optional<KeyframeJobResult> joined;  ///< the job's result, once it has been waited for
  int job_frames = 0;                       ///< frames since the job began
  PairAligner pairs;                        ///< alignments of keyframes for optimise()

  explicit State(const OdometryConfig& chosen) : config(chosen), cache(chosen.graph.cached_keyframes) {}

  Tracking start(const Frame& frame);
  Tracking align_near(std::size_t first, const Eigen::Isometry3d& T_world_guess);
  Tracking recover(const Frame& frame);
  [[nodiscard]] bool is_plausible(const Tracking& tracking) const;
  void improve_current(const Tracking& tracking);
  [[nodiscard]] bool is_far_from(std::size_t keyframe, const Tracking& tracking) const;
  void choose_keyframe(const Frame& frame, Tracking& tracking);
  void add_keyframe(const Frame& frame, const Tracking& tracking);
  void take_up(std::size_t keyframe);
  void store_open();
  void wait_for_job();
  Eigen::Isometry3d take_over_job();
};

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
  return align(live, references, T_world_guess, config.align);
}

Tracking Odometry::State::recover(const Frame& frame) {
  Tracking standing = align_near(kept.current, kept.T_world_last);
  if (standing && is_plausible(standing)) return standing;
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

/// Limits the change of motion between frames to what a hand can do. A recalibrating sensor seems to exceed
/// it.
bool Odometry::State::is_plausible(const Tracking& tracking) const {
  constexpr double kMost_m = 0.10, kMost_rad = 0.05;
  if (!has_pose(tracking)) return false;
  const Eigen::Isometry3d change = (kept.T_world_last * kept.T_last_next).inverse() * tracking.T_world_camera;
  return change.translation().norm() < kMost_m && Eigen::AngleAxisd(change.linear()).angle() < kMost_rad;
}

void Odometry::State::improve_current(const Tracking& tracking) {
  if (kept.current < kept.final_keyframes) return;
  const Keyframe& keyframe = kept.graph.keyframes[kept.current];
  improve_depth(open, open_measured, pyramid, tracking.T_world_camera.inverse() * keyframe.T_world_camera);
  open_is_newer = true;
  if (++kept.improved < config.improve_every) return;
  kept.improved = 0;
  halve_depth(open);
  auto made = std::make_shared<CachedKeyframe>();
  make_target_view(open, Eigen::Isometry3d::Identity(), config.view, made->reference);
  make_source_points(open, made->live);
  cache.put(kept.current, std::move(made));
}

bool Odometry::State::is_far_from(std::size_t keyframe, const Tracking& tracking) const {
  const Eigen::Isometry3d T =
      kept.graph.keyframes[keyframe].T_world_camera.inverse() * tracking.T_world_camera;
  return T.translation().norm() > config.keyframe_distance_m ||
         Eigen::AngleAxisd(T.linear()).angle() > config.keyframe_angle_deg * std::numbers::pi / 180.0;
}

void Odometry::State::choose_keyframe(const Frame& frame, Tracking& tracking) {
  const bool little_in_common = tracking.overlap < config.keyframe_overlap;
  if (!little_in_common && !is_far_from(kept.current, tracking)) return;
  const std::vector<std::size_t> near = keyframes_near(kept.graph.keyframes, tracking.T_world_camera, 1.0);
  if (!near.empty() && near.front() != kept.current && !is_far_from(near.front(), tracking)) {
    take_up(near.front());
    return;
  }
  tracking.T_world_camera = take_over_job() * tracking.T_world_camera;
  add_keyframe(frame, tracking);
}

void Odometry::State::add_keyframe(const Frame& frame, const Tracking& tracking) {
  store_open();
  open = pyramid;
  open.grey.resize(0, 0);
  open_measured.resize(open.levels.front().camera.width_px, open.levels.front().camera.height_px, 1);
  kept.graph.keyframes.push_back({frame.index, tracking.T_world_camera,
                                  std::make_shared<const StoredView>(store(open, open_measured)), 0,
                                  kept.path_length_m});
  ++kept.counts.keyframes;
  kept.current = kept.graph.keyframes.size() - 1;
  kept.improved = 0;
  auto made = std::make_shared<CachedKeyframe>();
  make_target_view(open, Eigen::Isometry3d::Identity(), config.view, made->reference);
  made->live = live;
  cache.put(kept.current, std::move(made));
  job = std::async(std::launch::async, run,
                   KeyframeJob{frame, kept.graph, cache, &kept.keyframe_database,
                               known.keyframes.empty() ? nullptr : &known},
                   job_config(config));
  job_frames = 0;
  kept.final_keyframes = pairs.advance(kept.graph.keyframes, job_config(config).join);
}

/// Makes another keyframe current: frames are aligned with it first, and refine its depth.
void Odometry::State::take_up(std::size_t keyframe) {
  if (keyframe == kept.current) return;
  store_open();
  kept.current = keyframe;
  kept.improved = 0;
  restore(*kept.graph.keyframes[keyframe].view, config.view, open);
  open_measured = kept.graph.keyframes[keyframe].view->measured;
}

void Odometry::State::store_open() {
  if (!std::exchange(open_is_newer, false)) return;
  Keyframe& keyframe = kept.graph.keyframes[kept.current];
  keyframe.view = std::make_shared<const StoredView>(store(open, open_measured));
  ++keyframe.revision;
}

void Odometry::State::wait_for_job() {
  if (job.valid()) joined = job.get();
}

/// Waits for the second thread and applies its result. Returns the resulting motion of poses near the current
/// keyframe.
Eigen::Isometry3d Odometry::State::take_over_job() {
  wait_for_job();
  if (!joined) return Eigen::Isometry3d::Identity();
  const Eigen::Isometry3d T_new_old = take_over(*std::exchange(joined, std::nullopt), kept);
  update_index(kept.keyframe_database);
  return T_new_old;
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
  const StoredView& view = *state_->kept.graph.keyframes[state_->kept.current].view;
  restore(view, config.view, state_->open);
  state_->open_measured = view.measured;
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
  make_pyramid(frame, s.config.view, s.pyramid);
  make_source_points(s.pyramid, s.live);
  const bool is_joining = s.job.valid() || s.joined;
  if (is_joining && ++s.job_frames >= s.config.apply_result_after_frames) s.take_over_job();
  const bool first = kept.graph.keyframes.empty();
  if (!first && is_camera_stationary(kept.last_moved_grey, s.pyramid.grey)) {
    ++kept.counts.tracked;
    kept.T_world_last = kept.last_moved.T_world_camera;
    kept.T_last_next.setIdentity();
    keep(kept, frame, kept.last_moved);
    return kept.last_moved;
  }
  Tracking tracking =
      first ? s.start(frame) : s.align_near(kept.current, kept.T_world_last * kept.T_last_next);
  if (!first && !s.is_plausible(tracking)) tracking = s.recover(frame);

  if (!has_pose(tracking)) {
    ++kept.counts.lost;
    tracking.T_world_camera = kept.T_world_last;
    kept.T_last_next.setIdentity();
    keep(kept, frame, tracking);
    return tracking;
  }
  const Eigen::Isometry3d T_last_next = kept.T_world_last.inverse() * tracking.T_world_camera;
  kept.path_length_m += length(T_last_next) * (tracking ? 1.0 : 10.0);
  if (tracking && !first) {
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
  State& s = *state_;
  std::vector<MapKeyframe>& keyframe_database = s.kept.keyframe_database.keyframes;
  ++s.kept.counts.frames;
  ++s.kept.counts.tracked;
  s.kept.frames.push_back(
      {frame.index, frame.stamp_s, std::nullopt, T_world_camera, TrackStatus::kTracked, true});
  const double limit = view_distance(
      Eigen::Translation3d(s.config.keyframe_distance_m, 0, 0) *
      Eigen::AngleAxisd(s.config.keyframe_angle_deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitX()));
  const bool known =
      std::any_of(keyframe_database.begin(), keyframe_database.end(), [&](const MapKeyframe& place) {
        return view_distance(place.T_world_camera.inverse() * T_world_camera) < limit;
      });
  if (known) return;
  keyframe_database.push_back(make_map_keyframe(frame, T_world_camera, s.config.place));
  ++s.kept.counts.keyframes;
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
