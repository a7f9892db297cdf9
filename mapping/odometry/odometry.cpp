// odometry.cpp: tracks a camera in an unknown room with keyframes and loop closure.
#include "mapping/odometry/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <future>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "mapping/alignment/feature_flow.hpp"
#include "mapping/alignment/keyframe_cache.hpp"
#include "mapping/alignment/packed_view.hpp"
#include "mapping/alignment/stationary_camera.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/keyframe_job.hpp"
#include "mapping/odometry/keyframe_pairs.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

KeyframeJobConfig job_config(const OdometryConfig& config) {
  return {{config.view, config.align_keyframes, config.graph}, config.place, config.relocalise};
}

}  // namespace

/// State between two frames, and the handling of the current keyframe.
struct Odometry::State {
  OdometryConfig config;
  KeyframeDatabase known;
  OdometrySnapshot kept;
  ViewPyramid pyramid;  ///< of the current frame, like `live`
  SourcePoints live;
  ReadoutMotion readout;    ///< of the current frame
  CameraVelocity velocity;  ///< of the current frame; 0 until its pose is known
  KeyframeCache cache;
  ViewPyramid open;  ///< pyramid of the current keyframe, refined by the frames tracked since
  Image<std::uint8_t> open_measured;
  bool open_is_newer = false;  ///< `open` is newer than the keyframe's stored view
  std::future<KeyframeJobResult> job;
  std::optional<KeyframeJobResult> joined;                  ///< the job's result, once it has been waited for
  int job_frames = 0;                                       ///< frames since the job began
  std::vector<std::shared_ptr<const CachedKeyframe>> used;  ///< keeps the references of align_near() alive
  FlowReference flow;             ///< corners followed where depth constrains the pose weakly
  std::size_t flow_keyframe = 0;  ///< keyframe to which the pose of `flow` is relative
  Eigen::Isometry3d T_keyframe_flow = Eigen::Isometry3d::Identity();
  CameraVelocity flow_velocity;  ///< of the camera when the corners of `flow` were taken
  bool is_pose_by_flow = false;  ///< of the current frame
  Frame first_frame;             ///< empty once the first keyframe's velocity is known
  PairAligner pairs;             ///< alignments of keyframes for optimise()

  explicit State(const OdometryConfig& chosen) : config(chosen), cache(chosen.graph.cached_keyframes) {}

  Tracking start(const Frame& frame);
  std::vector<PosedReference> references_near(std::size_t first, const Eigen::Isometry3d& T_world_guess);
  Tracking align_near(std::size_t first, const Eigen::Isometry3d& T_world_guess);
  std::optional<Tracking> follow_recorded(const Frame& frame, const PredictedMotion& predicted);
  Tracking find_pose(const Frame& frame, const PredictedMotion& predicted);
  Tracking recover(const Frame& frame);
  [[nodiscard]] bool is_plausible(const Tracking& tracking, const Eigen::Isometry3d& T_world_expected) const;
  void take_evidence(const Frame& frame, const Tracking& tracking);
  void remake_first_keyframe();
  void improve_current(const Tracking& tracking);
  void cache_open(std::size_t keyframe);
  [[nodiscard]] bool is_far_from(std::size_t keyframe, const Tracking& tracking) const;
  [[nodiscard]] bool has_other_view(std::size_t keyframe, const Tracking& tracking) const;
  void choose_keyframe(const Frame& frame, Tracking& tracking);
  void add_keyframe(const Frame& frame, const Tracking& tracking);
  void add_keyframe(const Frame& frame, const Tracking& tracking, int part);
  void constrain(const Frame& frame, const CameraVelocity& predicted, Tracking& tracking);
  void renew_flow(const Frame& frame, const Tracking& tracking);
  bool begin_part(const Frame& frame, Tracking& tracking);
  std::optional<Tracking> return_to_lost_place(const Frame& frame, const PredictedMotion& predicted);
  void merge_current_part(std::size_t keyframe, const Eigen::Isometry3d& T_world_found,
                          const Eigen::Isometry3d& T_world_tracked);
  void take_up(std::size_t keyframe);
  void store_open();
  void wait_for_job();
  Eigen::Isometry3d take_over_job();
};

/// The first keyframe's velocity is known once the second frame is tracked. The keyframe is then made again.
void Odometry::State::remake_first_keyframe() {
  Keyframe& keyframe = kept.graph.keyframes.front();
  keyframe.velocity = keyframe.steady_velocity = velocity;
  keyframe.timing = kept.timing.current;
  if (!first_frame.depth_m.empty())  // empty if a checkpoint was resumed after the first frame
    make_pyramid(std::exchange(first_frame, {}), config.view, open, {velocity, kept.timing.current});
  deskew(open, velocity, kept.timing.current.depth_readout_s);
  open.grey.resize(0, 0);
  open_is_newer = true;
  cache_open(0);
}

void Odometry::State::improve_current(const Tracking& tracking) {
  if (kept.current < kept.final_keyframes) return;
  const Keyframe& keyframe = kept.graph.keyframes[kept.current];
  improve_depth(open, open_measured, pyramid, tracking.T_world_camera.inverse() * keyframe.T_world_camera);
  open_is_newer = true;
  if (++kept.improved < config.improve_every) return;
  kept.improved = 0;
  halve_depth(open);
  cache_open(kept.current);
}

/// Caches the open view, prepared for alignment, as that of a keyframe.
void Odometry::State::cache_open(std::size_t keyframe) {
  std::shared_ptr<CachedKeyframe> made = cache.make_room(keyframe);
  const bool is_shared = job.valid() || made.use_count() != 1;  // with a job, which copied the cache
  if (is_shared) made = std::make_shared<CachedKeyframe>();
  make_target_view(open, Eigen::Isometry3d::Identity(), config.view, made->reference);
  make_source_points(open, made->live);
  cache.put(keyframe, std::move(made));
}

bool Odometry::State::is_far_from(std::size_t keyframe, const Tracking& tracking) const {
  const Eigen::Isometry3d T =
      kept.graph.keyframes[keyframe].T_world_camera.inverse() * tracking.T_world_camera;
  return T.translation().norm() > config.keyframe_distance_m ||
         Eigen::AngleAxisd(T.linear()).angle() > config.keyframe_angle_deg * std::numbers::pi / 180.0;
}

/// Returns true if the view has changed since the keyframe: by a few degrees, or by as much parallax. A frame
/// that has little in common with a keyframe of the same view, such as at the near end of the sensor's range,
/// or with a hand in front, would have as little in common with a new keyframe.
bool Odometry::State::has_other_view(std::size_t keyframe, const Tracking& tracking) const {
  constexpr double kOther_rad = 0.05;
  std::vector<float> inverse_depths = pyramid.levels.back().inverse_depth_per_m.pixels;
  std::erase_if(inverse_depths, [](float q) { return !(q > 0.0F); });
  if (inverse_depths.empty()) return true;
  const auto middle = inverse_depths.begin() + static_cast<std::ptrdiff_t>(inverse_depths.size() / 2);
  std::nth_element(inverse_depths.begin(), middle, inverse_depths.end());
  const Eigen::Isometry3d T =
      kept.graph.keyframes[keyframe].T_world_camera.inverse() * tracking.T_world_camera;
  return T.translation().norm() * static_cast<double>(*middle) + Eigen::AngleAxisd(T.linear()).angle() >
         kOther_rad;
}

void Odometry::State::choose_keyframe(const Frame& frame, Tracking& tracking) {
  const bool little_in_common =
      tracking.overlap < config.keyframe_overlap && has_other_view(kept.current, tracking);
  if (!little_in_common && !is_far_from(kept.current, tracking)) return;
  const std::vector<std::size_t> near = keyframes_near(kept.graph.keyframes, tracking.T_world_camera, 1.0,
                                                       kept.graph.keyframes[kept.current].part);
  if (!near.empty() && near.front() != kept.current && !is_far_from(near.front(), tracking)) {
    take_up(near.front());
    return;
  }
  tracking.T_world_camera = take_over_job() * tracking.T_world_camera;
  add_keyframe(frame, tracking);
}

void Odometry::State::add_keyframe(const Frame& frame, const Tracking& tracking) {
  add_keyframe(frame, tracking, kept.graph.keyframes.empty() ? 0 : kept.graph.keyframes[kept.current].part);
}

void Odometry::State::add_keyframe(const Frame& frame, const Tracking& tracking, int part) {
  store_open();
  open = pyramid;
  open.grey.resize(0, 0);
  open_measured.resize(open.levels.front().camera.width_px, open.levels.front().camera.height_px, 1);
  const bool use_recorded = config.use_recorded_poses && kept.prior.contradicted_in_a_row == 0;
  kept.graph.keyframes.push_back(
      {frame.index, tracking.T_world_camera,
       std::make_shared<const PackedView>(packed(store(open, open_measured))), 0, kept.path_length_m,
       velocity, mean_velocity(kept, tracking.T_world_camera, frame.stamp_s), kept.timing.current,
       use_recorded ? frame.T_world_camera : std::nullopt, part, is_pose_by_flow, kept.prior.stretch});
  if (config.use_recorded_poses && frame.T_world_camera) kept.graph.recorded_sigma_m = kept.prior.sigma_m;
  first_frame = kept.graph.keyframes.size() == 1 ? frame : Frame{};
  ++kept.counts.keyframes;
  kept.current = kept.graph.keyframes.size() - 1;
  kept.improved = 0;
  cache_open(kept.current);
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
  StoredView view = unpacked(*kept.graph.keyframes[keyframe].view);
  restore(view, config.view, open);
  open_measured = std::move(view.measured);
}

void Odometry::State::store_open() {
  if (!std::exchange(open_is_newer, false)) return;
  Keyframe& keyframe = kept.graph.keyframes[kept.current];
  keyframe.view = std::make_shared<const PackedView>(packed(store(open, open_measured)));
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

namespace {

/// Returns for how many frames the camera has stood: since the first frame, or for at least five; else 0.
int stood_frames(const OdometrySnapshot& kept) {
  constexpr int kLong_frames = 5;
  const std::vector<KeptFrame>& frames = kept.frames;
  int count = 0;
  while (count < static_cast<int>(frames.size()) && count < kLong_frames &&
         frames[frames.size() - 1 - static_cast<std::size_t>(count)].T_keyframe_camera.matrix() ==
             frames.back().T_keyframe_camera.matrix())
    ++count;
  return count == kLong_frames || count == static_cast<int>(frames.size()) ? count : 0;
}

/// Returns true if recorded poses say that the camera has moved since the last frame.
bool moves_by_prior(const OdometryConfig& config, const OdometrySnapshot& kept, const Frame& frame) {
  const double moved_m = std::max(0.004, 2.0 * kept.prior.jitter_m);  // or rad
  if (!config.use_recorded_poses) return false;
  const std::optional<Eigen::Isometry3d> T_prior = predicted_by(kept.prior, frame.T_world_camera);
  return T_prior && motion_length_m(kept.T_world_last.inverse() * *T_prior) > moved_m;
}

}  // namespace

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

/// Returns a keyframe and its neighbours as references; prepares at most one neighbour that is not cached.
/// Valid until the next call.
std::vector<PosedReference> Odometry::State::references_near(std::size_t first,
                                                             const Eigen::Isometry3d& T_world_guess) {
  // Max view_distance(); beyond it the frame overlaps the keyframe too little.
  constexpr double kUsefulReference = 0.7;
  const auto most = static_cast<std::size_t>(std::max(config.references, 1));
  const std::vector<Keyframe>& keyframes = kept.graph.keyframes;
  used = {cache.get(first, *keyframes[first].view, config.view)};
  std::vector<PosedReference> references{{&used[0]->reference, keyframes[first].T_world_camera}};
  bool made_one = false;
  for (const std::size_t i :
       keyframes_near(keyframes, T_world_guess, kUsefulReference, keyframes[first].part)) {
    if (i == first || references.size() >= most) continue;
    auto other = cache.find(i);
    if (!other && std::exchange(made_one, true)) continue;
    if (!other) other = cache.get(i, *keyframes[i].view, config.view);
    references.push_back({&other->reference, keyframes[i].T_world_camera});
    used.push_back(std::move(other));
  }
  return references;
}

/// Aligns the frame with a keyframe and its neighbours.
Tracking Odometry::State::align_near(std::size_t first, const Eigen::Isometry3d& T_world_guess) {
  return align(live, references_near(first, T_world_guess), T_world_guess, config.align, readout);
}

/// Tracks the frame from the predicted pose, or recovers.
Tracking Odometry::State::find_pose(const Frame& frame, const PredictedMotion& predicted) {
  readout = {kept.T_world_last, predicted.dt_s, kept.timing.current.depth_readout_s};
  if (std::optional<Tracking> tracking = follow_recorded(frame, predicted)) return *tracking;
  Tracking tracking = align_near(kept.current, predicted.T_world_camera);
  constrain(frame, predicted.velocity, tracking);
  // After a long step the guess is poor, and an alignment that depth constrains weakly may have ended
  // anywhere.
  constexpr double kLongStep_s = 0.35;
  const bool is_unsure = predicted.dt_s > kLongStep_s && is_weak(tracking) && !is_pose_by_flow;
  if (!is_unsure && is_plausible(tracking, predicted.T_world_camera)) {
    velocity = velocity_of(kept.T_world_last.inverse() * tracking.T_world_camera, predicted.dt_s);
    return tracking;
  }
  readout = {};
  velocity = {};
  return recover(frame);
}

/// Tracks the frame from the pose that the recorded poses predict, and combines both. Returns nullopt if
/// there is no prediction, or if depth contradicts it: another pose then explains the depth clearly better.
std::optional<Tracking> Odometry::State::follow_recorded(const Frame& frame,
                                                         const PredictedMotion& predicted) {
  // Max difference of an alignment that started from the recorded pose; beyond it, one of the two is wrong.
  constexpr double kMost_m = 0.15;
  constexpr double kClearlyMore = 0.2;  // inliers that an alignment must add to contradict a recorded pose
  // Below kFewInliers, depth does not support the recorded pose. It is wrong if another pose has
  // kManyInliers.
  constexpr double kFewInliers = 0.5, kManyInliers = 0.7, kNoSupport = 0.2, kMinOverlap = 0.2;
  constexpr double kSameView = 0.7;                          // view_distance()
  constexpr double kMostStep_m = 0.3, kMostSpeed_mps = 3.0;  // a larger step is a jump of the recorded world
  if (!config.use_recorded_poses) return std::nullopt;
  const std::optional<Eigen::Isometry3d> T_prior = predicted_by(kept.prior, frame.T_world_camera);
  if (!T_prior) return std::nullopt;
  const double step_m = (kept.T_world_last.inverse() * *T_prior).translation().norm();
  if (!(step_m < kMostStep_m + kMostSpeed_mps * std::clamp(predicted.dt_s, 0.0, 2.0))) {
    count_contradiction(kept.prior);
    return std::nullopt;
  }
  const auto with_velocity = [&](const Tracking& tracking) {
    velocity = velocity_of(kept.T_world_last.inverse() * tracking.T_world_camera, predicted.dt_s);
    return tracking;
  };
  std::size_t first = kept.current;
  if (view_distance(kept.graph.keyframes[first].T_world_camera.inverse() * *T_prior) > kSameView) {
    const auto near =
        keyframes_near(kept.graph.keyframes, *T_prior, kSameView, kept.graph.keyframes[first].part);
    if (!near.empty()) first = near.front();
  }
  const Tracking aligned = align_near(first, *T_prior);
  const double difference_m = constrained_difference_m(*T_prior, aligned);
  const bool is_near = has_pose(aligned) && difference_m < kMost_m;
  if (is_near && !contradicts(kept.prior, difference_m))
    return with_velocity(combine(kept.prior, *T_prior, aligned, predicted.dt_s));

  const DepthFit fit = depth_fit(live, references_near(first, *T_prior), *T_prior, config.align);
  if (is_near && aligned.inlier_fraction > fit.inlier_fraction + kClearlyMore) {
    // After a jump of the recorded world, the constant velocity predicts better than the recorded motion.
    const Tracking without = align_near(kept.current, predicted.T_world_camera);
    if (is_plausible(without, predicted.T_world_camera) && without &&
        without.inlier_fraction >= aligned.inlier_fraction) {
      count_contradiction(kept.prior);
      return with_velocity(without);
    }
    return with_velocity(combine(kept.prior, *T_prior, aligned, predicted.dt_s));
  }
  const bool may_be_wrong = fit.overlap > kMinOverlap && fit.inlier_fraction < kFewInliers;
  if (may_be_wrong) {
    const Tracking without = align_near(kept.current, predicted.T_world_camera);
    if (is_plausible(without, predicted.T_world_camera) && without && without.overlap > kMinOverlap &&
        without.inlier_fraction > kManyInliers) {
      count_contradiction(kept.prior);
      return with_velocity(without);
    }
  }
  Tracking tracking;  // lost if depth does not support the recorded pose at all, such as behind a hand
  tracking.T_world_camera = *T_prior;
  tracking.overlap = fit.overlap;
  tracking.inlier_fraction = fit.inlier_fraction;
  if (fit.overlap < kMinOverlap || fit.inlier_fraction > kNoSupport) {
    tracking.status = TrackStatus::kTracked;
    tracking.information = prior_information(kept.prior.sigma_m, Eigen::Isometry3d::Identity());
    ++kept.prior.used;
  }
  return with_velocity(tracking);
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

/// Where depth constrains the pose weakly, such as over a bare floor, corners constrain it. While the camera
/// turns, corners are not where a global shutter would show them. They are not used if the camera turns
/// otherwise than when they were taken.
void Odometry::State::constrain(const Frame& frame, const CameraVelocity& predicted, Tracking& tracking) {
  constexpr double kMost_px = 0.75;
  constexpr std::size_t kTimingFrames = 30;  // the delay of colour is estimated in this time
  is_pose_by_flow = false;
  if (kept.frames.size() < kTimingFrames) return;
  const SensorTiming& timing = kept.timing.current;
  const double late_s = 0.5 * timing.colour_readout_s + std::abs(timing.colour_delay_s);
  const double focal_px =
      frame.colour.empty() ? 0.0 : frame.colour_camera.fx_px * pyramid.grey.width / frame.colour.width;
  const double turns_radps = (predicted.angular_radps - flow_velocity.angular_radps).norm();
  if (turns_radps * late_s * focal_px > kMost_px) return;
  if (!has_pose(tracking) || flow.corners_px.empty() || !is_weak(tracking)) return;
  if (kept.graph.keyframes[flow_keyframe].part != kept.graph.keyframes[kept.current].part) return;
  const Eigen::Isometry3d T_world_flow = kept.graph.keyframes[flow_keyframe].T_world_camera * T_keyframe_flow;
  const FlowPose pose = constrain_by_flow(flow, T_world_flow, frame, pyramid.grey, tracking, config.align);
  is_pose_by_flow = pose.is_used;
  tracking = pose.tracking;
}

/// Takes corners from this frame if those that are followed show too little of its view.
void Odometry::State::renew_flow(const Frame& frame, const Tracking& tracking) {
  constexpr double kSameView = 0.15;  // view_distance(): some 5 degrees
  if (!flow.corners_px.empty() && flow_keyframe < kept.graph.keyframes.size() &&
      kept.graph.keyframes[flow_keyframe].part == kept.graph.keyframes[kept.current].part) {
    const Eigen::Isometry3d T_world_flow =
        kept.graph.keyframes[flow_keyframe].T_world_camera * T_keyframe_flow;
    if (view_distance(T_world_flow.inverse() * tracking.T_world_camera) < kSameView) return;
  }
  flow = make_flow_reference(frame, pyramid.grey);
  flow_keyframe = kept.current;
  flow_velocity = velocity;
  T_keyframe_flow = kept.graph.keyframes[kept.current].T_world_camera.inverse() * tracking.T_world_camera;
}

/// Begins a new part of the scan with this frame, at the last known pose. Returns false if the frame has too
/// little depth.
bool Odometry::State::begin_part(const Frame& frame, Tracking& tracking) {
  if (predicted_by(kept.prior, frame.T_world_camera)) return false;
  if (live.levels.front().size() < static_cast<std::size_t>(std::max(config.align.min_points, 1)))
    return false;
  if (frame.colour.empty() && !kept.last_moved_grey.empty()) return false;  // this frame alone
  take_over_job();
  if (!kept.lost)
    kept.lost = LostPlace{kept.current,
                          kept.graph.keyframes[kept.current].T_world_camera.inverse() * kept.T_world_last,
                          frame.stamp_s};
  tracking = {};
  tracking.status = TrackStatus::kTracked;
  tracking.T_world_camera = kept.T_world_last;
  tracking.overlap = tracking.inlier_fraction = 1.0;
  velocity = {};
  add_keyframe(frame, tracking, kept.parts++);
  return true;
}

/// For 1 s after a loss, tries the place of the loss and the keyframes of other parts. If the frame is found
/// there and is tracked in the current part as well, merges the current part into the other.
std::optional<Tracking> Odometry::State::return_to_lost_place(const Frame& frame,
                                                              const PredictedMotion& predicted) {
  constexpr double kLongest_s = 1.0;
  if (!kept.lost) return std::nullopt;
  if (frame.stamp_s - kept.lost->stamp_s > kLongest_s) {
    kept.lost.reset();
    return std::nullopt;
  }
  readout = {};
  const Eigen::Isometry3d T_world_guess = take_over_job() * predicted.T_world_camera;
  const int part = kept.graph.keyframes[kept.current].part;
  std::size_t keyframe = kept.lost->keyframe;
  const Eigen::Isometry3d T_world_lost =
      kept.graph.keyframes[keyframe].T_world_camera * kept.lost->T_keyframe_camera;
  Tracking found = align_near(keyframe, T_world_lost);
  if (!found || !is_plausible(found, T_world_lost)) {
    const Relocalisation at_known =
        relocalise(frame, kept.keyframe_database, config.relocalise,
                   [&](std::size_t i) { return kept.graph.keyframes[i].part != part; });
    if (!at_known) return std::nullopt;
    keyframe = static_cast<std::size_t>(at_known.keyframe);
    found = align_near(keyframe, at_known.T_world_camera);
    if (!found) return std::nullopt;
  }
  ++kept.counts.relocalised;
  const Tracking tracked = align_near(kept.current, T_world_guess);
  if (is_plausible(tracked, T_world_guess) && tracked)
    merge_current_part(keyframe, found.T_world_camera, tracked.T_world_camera);
  take_up(keyframe);
  kept.T_world_last = found.T_world_camera;
  kept.lost.reset();
  velocity = {};
  return found;
}

/// Moves the current part to where a frame was found in another part, and connects both.
/// @param keyframe         keyframe of the other part
/// @param T_world_found    the frame's pose in the other part
/// @param T_world_tracked  the frame's pose in the current part
void Odometry::State::merge_current_part(std::size_t keyframe, const Eigen::Isometry3d& T_world_found,
                                         const Eigen::Isometry3d& T_world_tracked) {
  constexpr double kSigma_m = 0.01, kSigma_rad = 0.005;  // standard deviations of a relocalised pose
  const Eigen::Isometry3d T_other_current = T_world_found * T_world_tracked.inverse();
  std::vector<Keyframe> moved = kept.graph.keyframes;
  const int part = moved[kept.current].part;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (moved[i].part != part) continue;
    moved[i].T_world_camera = T_other_current * moved[i].T_world_camera;
    kept.graph.keyframes[i].part = moved[keyframe].part;
  }
  move_keyframes(moved, kept);
  Matrix6d information = Matrix6d::Zero();
  information.diagonal().head<3>().setConstant(1.0 / (kSigma_m * kSigma_m));
  information.diagonal().tail<3>().setConstant(1.0 / (kSigma_rad * kSigma_rad));
  const std::vector<Keyframe>& keyframes = kept.graph.keyframes;
  kept.graph.constraints.push_back(
      {keyframe, kept.current,
       keyframes[keyframe].T_world_camera.inverse() * keyframes[kept.current].T_world_camera, information,
       true, false});
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
  const auto current = cache.get(kept.current, *keyframe.view, config.view);
  add_evidence(kept.timing,
               timing_evidence(
                   live, {tracking.T_world_camera, velocity, steady, kept.timing.current}, current->reference,
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

int Odometry::current_part() const {
  const OdometrySnapshot& kept = state_->kept;
  return kept.graph.keyframes.empty() ? 0 : kept.graph.keyframes[kept.current].part;
}

const OdometrySnapshot& Odometry::state() const { return state_->kept; }

Tracking Odometry::track(const Frame& frame) {
  State& s = *state_;
  OdometrySnapshot& kept = s.kept;
  ++kept.counts.frames;
  const bool first = kept.graph.keyframes.empty();
  if (kept.counts.frames == 1) kept.timing = start_estimate(s.config.timing.value_or(frame.timing));
  if (s.config.use_recorded_poses && frame.T_world_camera)
    note_recorded(kept.prior, frame.stamp_s, *frame.T_world_camera);
  const PredictedMotion predicted = predict(kept, frame.stamp_s);
  make_pyramid(frame, s.config.view, s.pyramid, {predicted.velocity, kept.timing.current});
  make_source_points(s.pyramid, s.live);
  const bool is_joining = s.job.valid() || s.joined;
  if (is_joining && ++s.job_frames >= s.config.apply_result_after_frames) s.take_over_job();
  if (!first && !moves_by_prior(s.config, kept, frame) &&
      is_camera_stationary(kept.last_moved_grey, s.pyramid.grey, stood_frames(kept))) {
    kept.is_stationary = true;
    ++kept.counts.tracked;
    kept.T_world_last = kept.last_moved.T_world_camera;
    kept.T_last_next.setIdentity();
    keep(kept, frame, kept.last_moved);
    return kept.last_moved;
  }
  kept.is_stationary = false;
  Tracking tracking;
  if (first) {
    tracking = s.start(frame);
  } else if (const std::optional<Tracking> returned = s.return_to_lost_place(frame, predicted)) {
    tracking = *returned;
  } else {
    tracking = s.find_pose(frame, predicted);
  }
  const bool begins_part =
      !first && !has_pose(tracking) && !kept.graph.keyframes.empty() && s.begin_part(frame, tracking);
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
  if (tracking && !first && !begins_part) {
    // The first keyframe was made with the velocity of one pair of frames.
    if (s.config.estimate_timing && kept.current > 0) s.take_evidence(frame, tracking);
    deskew(s.pyramid, s.velocity, kept.timing.current.depth_readout_s);
    s.improve_current(tracking);
    s.choose_keyframe(frame, tracking);
  }
  if (s.config.use_recorded_poses && tracking && frame.T_world_camera && !kept.prior.T_world_recorded)
    restart_prior(kept.prior, tracking.T_world_camera, *frame.T_world_camera);
  ++(tracking ? kept.counts.tracked : kept.counts.degenerate);
  kept.T_last_next = expected_motion(tracking, T_last_next);
  kept.T_world_last = tracking.T_world_camera;
  kept.last_moved_grey.resize(0, 0);
  if (tracking && !kept.graph.keyframes.empty()) s.renew_flow(frame, tracking);
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
