// odometry.hpp: where the camera was, frame by frame, in a room that is not known yet.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "mapping/alignment/align.hpp"
#include "mapping/alignment/view.hpp"
#include "mapping/localization/keyframe_database.hpp"
#include "mapping/odometry/keyframe_graph.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

struct OdometryConfig {
  ViewConfig view;
  /// Colour says less than its noise: its camera is not where it is taken for, and walls shine.
  AlignConfig align = {.intensity_sigma = 16.0F, .max_correction_m = 0.25F};
  /// Of keyframes with one another. They are further apart, where the depth's distortion shows: a wide soft
  /// edge lets it average out. Chosen on the kitchen recording, as is the weight of colour above: each
  /// changes ATE and RPE over 30 frames by 0.3 mm or less.
  AlignConfig align_keyframes = {.robust_sigma = 4.0F, .intensity_sigma = 8.0F, .max_correction_m = 0.25F};
  KeyframeGraphConfig graph;
  PlaceConfig place;
  RelocaliseConfig relocalise;
  double keyframe_distance_m = 0.10;  ///< a view further than this from every keyframe becomes one
  double keyframe_angle_deg = 8.0;
  double keyframe_overlap = 0.7;  ///< or one that has less than this in common with the nearest
  int references = 2;             ///< keyframes that a frame is aligned with at once
  int improve_every = 5;          ///< views averaged into a keyframe before its reference is made anew
  int join_frames = 4;            ///< after so many frames a new keyframe is joined with the others
};

/// A frame's place in the trajectory.
struct TrackedFrame {
  std::int64_t frame_index = 0;
  double stamp_s = 0.0;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  TrackStatus status = TrackStatus::kDiverged;
  bool trusted = false;  ///< only then is the frame to be fused
};

struct OdometryCounts {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;      ///< trusted ones
  std::int64_t degenerate = 0;   ///< frames in which some direction was held
  std::int64_t lost = 0;         ///< frames without a pose
  std::int64_t relocalised = 0;  ///< times that tracking came back by recognising a place
  std::int64_t keyframes = 0;
  std::int64_t loops_found = 0;     ///< pairs of keyframes, not neighbours in time, that are joined
  std::int64_t loops_rejected = 0;  ///< pairs that should see the same and did not align both ways
  std::int64_t anchored = 0;        ///< keyframes that were found in the known places
};

struct OdometrySnapshot;

/// Tracks a camera against keyframes, closes loops, and gives all poses at the end. The world is the first
/// usable frame's camera, unless frames come with poses (add_posed) or the camera is found in known places.
/// New keyframes are joined with the others on a second thread; when their answer is taken over is counted in
/// frames, so that the poses do not depend on the threads. Not thread safe.
class Odometry {
 public:
  explicit Odometry(const OdometryConfig& config = {});
  Odometry(Odometry&&) noexcept;
  Odometry& operator=(Odometry&&) noexcept;
  ~Odometry();

  /// Gives places of a map made before, in its world and held there; before the first frame. Frames are
  /// looked for in them, and once one is found the odometry's world is the map's, also for the frames before.
  void know(Places known);
  /// Whether the world is that of the known places.
  [[nodiscard]] bool is_located() const;

  /// The pose of the next frame, as far as it is known now. After a loss the frame is looked for near where
  /// the camera was and in all keyframes. The frame's images must have its cameras' sizes.
  Tracking track(const Frame& frame);

  /// Takes the pose as given: places are chosen and described, nothing is aligned and nothing optimised.
  void add_posed(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Joins the keyframes anew with all that is known now, optimises their poses, and returns all frames so
  /// far with their final poses.
  std::vector<TrackedFrame> optimise();

  /// The keyframes as places, with their present poses; call optimise() first. They are no longer held here.
  Places take_places();

  [[nodiscard]] OdometryCounts counts() const;

  /// Waits until the second thread has nothing to do; before a snapshot or a fork. Moves no pose: what it
  /// found is taken over when it would have been anyway.
  void settle();
  /// All that is known, to go on from, with what the second thread found taken over. Views are shared, not
  /// copied. Only after settle().
  [[nodiscard]] OdometrySnapshot snapshot() const;
  /// Goes on from a snapshot; known places must be given again. What it holds must fit together
  /// (load_odometry() sees to that).
  Odometry(const OdometryConfig& config, OdometrySnapshot snapshot);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
