// odometry_state.hpp: state of an odometry between two frames, and the handling of its current keyframe.
#pragma once
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <vector>

#include "mapping/alignment/feature_flow.hpp"
#include "mapping/alignment/keyframe_cache.hpp"
#include "mapping/odometry/keyframe_job.hpp"
#include "mapping/odometry/keyframe_pairs.hpp"
#include "mapping/odometry/odometry.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"

namespace roomradar {

KeyframeJobConfig job_config(const OdometryConfig& config);

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

}  // namespace roomradar
