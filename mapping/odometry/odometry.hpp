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

/// Tracks a camera against keyframes, closes loops, and returns all poses at the end. The world is the first
/// usable frame's camera, unless frames come with poses (add_posed) or the camera is localised in a known
/// map. A second thread connects new keyframes to the others. Its results are applied after a fixed number of
/// frames, so poses do not depend on timing. Not thread safe.
class Odometry {
 public:
  explicit Odometry(const OdometryConfig& config = {});
  Odometry(Odometry&&) noexcept;
  Odometry& operator=(Odometry&&) noexcept;
  ~Odometry();

  /// Sets the keyframe database of an earlier map, whose poses stay constant; call before the first frame.
  /// New keyframes are searched for in it. Once one is found, the odometry's world is the map's, for earlier
  /// frames too.
  void set_prior_map(KeyframeDatabase known);
  /// Returns whether the world is that of the known map.
  [[nodiscard]] bool is_located() const;

  /// Returns the current estimate of the next frame's pose. After a loss, searches near the last pose, then
  /// in all keyframes. The frame's images must have its cameras' sizes.
  Tracking track(const Frame& frame);

  /// Adds a frame with a given pose: keyframes are selected and described, but nothing is aligned or
  /// optimised.
  void add_posed(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Rebuilds all constraints from the current depth, optimises the keyframes' poses, and returns all frames
  /// so far with their final poses.
  std::vector<TrackedFrame> optimise();

  /// Moves the keyframe database out, with current poses; call optimise() first.
  KeyframeDatabase take_keyframe_database();

  [[nodiscard]] OdometryCounts counts() const;

  /// Waits until the second thread is idle; call before a snapshot or a fork. Changes no pose: the thread's
  /// result is applied at its usual frame.
  void finish_jobs();
  /// Returns the complete state, with the second thread's result applied. Views are shared, not copied. Call
  /// only after finish_jobs().
  [[nodiscard]] OdometrySnapshot snapshot() const;
  /// Resumes from a snapshot; the known map must be set again. The snapshot must be consistent
  /// (load_odometry() checks this).
  Odometry(const OdometryConfig& config, OdometrySnapshot snapshot);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
