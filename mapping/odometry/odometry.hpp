// odometry.hpp: tracks a camera in an unknown room with keyframes and loop closure.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/localization/relocalise.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

struct OdometryConfig {
  ViewConfig view;
  /// Colour has less weight than its noise justifies: the colour camera's calibration is inexact, and walls
  /// are glossy.
  AlignConfig align = {.intensity_sigma = 16.0F, .max_correction_m = 0.25F};
  /// For alignment of keyframes with one another. They are farther apart, where the depth's distortion shows;
  /// a wide robust kernel averages it out. Chosen on the kitchen recording, like the weight of colour above:
  /// each changes ATE and RPE over 30 frames by 0.3 mm or less.
  AlignConfig align_keyframes = {.robust_sigma = 4.0F, .intensity_sigma = 8.0F, .max_correction_m = 0.25F};
  KeyframeGraphConfig graph;
  KeyframeDatabaseConfig place;
  RelocaliseConfig relocalise;
  /// A view becomes a keyframe if every keyframe is farther away than this or turned by more than
  /// keyframe_angle_deg.
  double keyframe_distance_m = 0.10;
  double keyframe_angle_deg = 8.0;
  double keyframe_overlap = 0.7;      ///< below this overlap with the current keyframe, another one is used
  int references = 2;                 ///< max keyframes that a frame is aligned with
  int improve_every = 5;              ///< views averaged into a keyframe before its reference is rebuilt
  int apply_result_after_frames = 4;  ///< frames after which a new keyframe's background result is applied
};

/// Trajectory entry of one frame.
struct TrackedFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;  ///< only trusted frames may be fused
};

struct OdometryCounts {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;      ///< frames with a trusted pose
  std::int64_t degenerate = 0;   ///< frames with an unconstrained direction
  std::int64_t lost = 0;         ///< frames without a pose
  std::int64_t relocalised = 0;  ///< recoveries from a loss by place recognition
  std::int64_t keyframes = 0;
  std::int64_t loops_found = 0;     ///< connected pairs of keyframes that are not neighbours in sequence
  std::int64_t loops_rejected = 0;  ///< pairs that should overlap, but did not align both ways
  std::int64_t anchored = 0;        ///< keyframes that were localised in the known map
};

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
