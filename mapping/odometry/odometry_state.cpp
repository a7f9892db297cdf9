// odometry_state.cpp: handles the current keyframe: choice, depth refinement, and results of the background
// job.
#include "mapping/odometry/odometry_state.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "mapping/alignment/packed_view.hpp"

namespace roomradar {

KeyframeJobConfig job_config(const OdometryConfig& config) {
  return {{config.view, config.align_keyframes, config.graph}, config.place, config.relocalise};
}

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

}  // namespace roomradar
