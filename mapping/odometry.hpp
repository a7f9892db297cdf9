// odometry.hpp: where the camera was, frame by frame, in a room that is not known yet.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "mapping/align.hpp"
#include "mapping/keyframe_graph.hpp"
#include "mapping/places.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/view.hpp"

namespace roomradar {

struct OdometryConfig {
  ViewConfig view;
  AlignConfig align = {.intensity_sigma = 5.0F, .max_correction_m = 0.25F};
  KeyframeGraphConfig graph;
  PlaceConfig place;
  RelocaliseConfig relocalise;
  double keyframe_distance_m = 0.10;  ///< a view further than this from every keyframe becomes one
  double keyframe_angle_deg = 8.0;
  double keyframe_overlap = 0.7;  ///< or one that has less than this in common with the nearest
  int references = 3;             ///< keyframes that a frame is aligned with at once
  int improve_every = 5;          ///< views averaged into a keyframe before its reference is made anew
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
};

/// Tracks a camera against keyframes, closes loops, and gives all poses at the end. The world is the first
/// usable frame's camera, unless frames come with poses (add_posed). Not thread safe.
class Odometry {
 public:
  explicit Odometry(const OdometryConfig& config = {});
  Odometry(Odometry&&) noexcept;
  Odometry& operator=(Odometry&&) noexcept;
  ~Odometry();

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

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
