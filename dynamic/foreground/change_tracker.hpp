// change_tracker.hpp: detects lasting changes: objects that were added and stay, and objects that were
// removed.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "dynamic/foreground/change_clusters.hpp"
#include "dynamic/foreground/change_tracker_config.hpp"
#include "dynamic/foreground/foreground.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// Stores world points on dynamic and on removed surfaces, and projects them into every depth image. A frame
/// confirms a point on a dynamic surface if it measures the surface at the point. A frame confirms a point on
/// a removed surface if it sees through the point. Only confirming frames add to the point's steady_s. A
/// frame that measures the point's position but does not confirm the point contradicts it. The point is
/// dropped once its contradiction score exceeds 7 (ChangePoint::contradiction). Hidden points and points out
/// of view keep their score and steady_s. Hence the result does not depend on the camera's motion. Allocates
/// nothing after the first frame except the changes it returns. Not thread safe.
class ChangeTracker {
 public:
  explicit ChangeTracker(const ChangeTrackerConfig& config = {});

  /// Sets the noise of the sensor of later frames.
  void set_noise(const DepthNoise& noise) { config_.noise = noise; }
  /// Processes one frame. Images must have the camera's size. `labels` must be the result of
  /// mark_foreground() for this depth and expected depth. stamp_s is the frame's time. A gap between two
  /// frames counts as at most 0.5 s.
  void update(const DepthImage& depth_m, const DepthImage& expected_depth_m, const LabelImage& labels,
              const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, double stamp_s);

  /// Returns the objects that were confirmed for at least this many seconds and are in view now. Later calls
  /// return an object again until it is forgotten, moves, or agrees with the expected depth.
  [[nodiscard]] std::vector<LastingChange> lasting_changes(double seconds);

  /// Returns the fraction of a change's points that have not been dropped.
  [[nodiscard]] double still_true(const LastingChange& change) const;
  /// Returns the fraction of a change's points that the last frame confirmed.
  [[nodiscard]] double seen_now(const LastingChange& change) const;
  /// Drops a change's points, so lasting_changes() no longer returns the change.
  void forget(const LastingChange& change);

  [[nodiscard]] std::size_t point_count() const { return points_.size(); }

 private:
  struct View;  // images, camera and pose of one frame

  /// Updates a point from the frame. Returns false if the point must be dropped.
  bool review(const View& view, float dt_s, ChangePoint& point);
  void add_points(const View& view);
  void cover(const View& view, LastingKind kind, float u_px, float v_px, float depth_m);

  ChangeTrackerConfig config_;
  Eigen::Vector3d origin_world_ = Eigen::Vector3d::Zero();  ///< camera position in the first frame
  bool has_origin_ = false;
  double last_stamp_s_ = 0.0;
  std::uint32_t next_id_ = 1;
  std::vector<ChangePoint> points_;  ///< sorted by id
  /// Bits per pixel of the sampling grid. Bit 1 << kind: a point of that kind covers the pixel.
  std::vector<std::uint8_t> covered_;
  ChangeClusters clusters_;
};

}  // namespace roomradar
