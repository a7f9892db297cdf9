// odometry.hpp: tracks a camera in an unknown room with keyframes and loop closure.
#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/odometry_config.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

struct OdometrySnapshot;

/// Tracks a camera against keyframes, closes loops, and returns all poses at the end. The world frame is the
/// camera frame of the first usable frame, unless frames come with poses (add_posed()) or the camera is
/// localised in a known map. One background thread connects each new keyframe to older ones; its result is
/// applied 4 frames later, or before the next keyframe, a new part or a search for a lost place if that is
/// earlier. Another thread aligns keyframes; only optimise() uses its results. Poses therefore depend on the
/// frames only, not on thread timing. Not thread safe.
class Odometry {
 public:
  explicit Odometry(const OdometryConfig& config = {});
  Odometry(Odometry&&) noexcept;
  Odometry& operator=(Odometry&&) noexcept;
  ~Odometry();

  /// Sets the keyframe database of an earlier map; call before the first frame. Each new keyframe is
  /// localised in the earlier map if possible. Once a keyframe has been localised, all poses are in the
  /// earlier map's world frame, including poses of earlier frames. The earlier map's own poses stay constant.
  void set_prior_map(KeyframeDatabase known);

  /// Tracks the next frame and returns its current pose estimate. A frame that cannot be tracked is tried at
  /// the last pose, then against all keyframes (relocalise()). If both fail, the frame usually begins a new
  /// part of the scan; for 1 s, later frames are also tried where tracking was lost. The images must have the
  /// sizes of the frame's cameras.
  Tracking track(const Frame& frame);

  /// Returns the part (Keyframe::part) of the last tracked frame. A new part begins where tracking was lost.
  [[nodiscard]] int current_part() const;

  /// Adds a frame with a given pose. Adds a keyframe to the database if the pose differs enough from those of
  /// all keyframes (OdometryConfig::keyframe_distance_m, keyframe_angle_deg). Does not align or optimise.
  void add_posed(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Rebuilds all constraints from the keyframes' final depth, optimises the keyframes' poses, and returns
  /// all frames so far with their final poses.
  std::vector<TrackedFrame> optimise();

  /// Moves the keyframe database out, with current poses and without an index. Call optimise() first.
  KeyframeDatabase take_keyframe_database();

  [[nodiscard]] OdometryCounts counts() const;
  /// Returns the state after the last frame, without pending results of the background threads.
  [[nodiscard]] const OdometrySnapshot& state() const;

  /// Waits until the thread that connects keyframes is idle. Changes no pose: the thread's result is
  /// applied later, at the frame where it is due.
  void finish_jobs();
  /// Returns a copy of the complete state, with the pending result of the thread that connects keyframes
  /// applied. Views are shared, not copied. Call only after finish_jobs().
  [[nodiscard]] OdometrySnapshot snapshot() const;
  /// Resumes from a snapshot, which must be consistent (load_odometry() checks this). Call set_prior_map()
  /// again if it was used.
  Odometry(const OdometryConfig& config, OdometrySnapshot snapshot);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
