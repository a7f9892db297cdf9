// odometry.hpp: where the camera was, frame by frame, in a room that is not known yet.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "mapping/align.hpp"
#include "mapping/places.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

struct OdometryConfig {
  ViewConfig view;
  AlignConfig align;
  PlaceConfig place;
  double keyframe_distance_m = 0.15;  ///< a view further than this from every keyframe becomes one
  double keyframe_angle_deg = 12.0;
  double keyframe_overlap = 0.7;  ///< or that has less than this in common with the newest
  int references = 3;             ///< keyframes that a frame is aligned with at once
  bool solve_online = true;
  double furthest = 1.0;
  double max_gap = 0.03;
  int loop_candidates = 8;  ///< older keyframes with overlap that a new keyframe is joined with
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
  std::int64_t relocalised = 0;  ///< times that tracking came back after a loss
  std::int64_t keyframes = 0;
  std::int64_t loops_found = 0;     ///< pairs of keyframes, not neighbours in time, that were joined
  std::int64_t loops_rejected = 0;  ///< pairs that looked alike and were refused
};

/// Tracks a camera against keyframes, closes loops, and gives all poses at the end. The world is the first
/// trusted frame's camera, unless frames come with poses (add_posed). Not thread safe.
class Odometry {
 public:
  explicit Odometry(const OdometryConfig& config = {});
  Odometry(Odometry&&) noexcept;
  Odometry& operator=(Odometry&&) noexcept;
  ~Odometry();

  /// The pose of the next frame, as far as it is known now. After a loss the frame is looked for in all
  /// keyframes.
  Tracking track(const Frame& frame);

  /// Takes the pose as given: keyframes are chosen and described, nothing is aligned and nothing optimised.
  void add_posed(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Optimises the keyframes' poses over all their joints, and returns all frames so far with their final
  /// poses.
  std::vector<TrackedFrame> optimise();

  /// The keyframes as places, with the poses of the last optimise() or add_posed(). They are no longer held
  /// here.
  Places take_places();

  [[nodiscard]] const OdometryCounts& counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
