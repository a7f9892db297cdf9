// simulated_source.hpp: a simulated Kinect in a procedural room, with ground truth for each frame.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

struct Room;

/// Ground truth of one frame. Images have the depth image's size.
struct SimTruth {
  /// Exact depth along the pixel's centre ray at the time of its row, m; 0 if outside the sensor's range.
  DepthImage depth_m;
  /// 255 if the nearest surface is a moving object.
  MaskImage moved;
  /// 0 for the room, otherwise 1 + index in SimOptions::movers. A crate that appears has the number 1 +
  /// SimOptions::movers.size().
  MaskImage mover;
  /// 255 if a crate that has disappeared would be the nearest surface.
  MaskImage revealed;
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// A frame's pose and stamp are those of the middle of its depth image. Frame i depends only on the options
/// and i. Reading it again gives the same pixels. The world frame is that of the room (z up, metres, floor at
/// z = 0). room() does not contain a crate that appears or disappears.
class SimulatedSource final : public FrameSource {
 public:
  /// Throws Error if the options are not valid.
  explicit SimulatedSource(const SimOptions& options);
  ~SimulatedSource() override;

  ReadResult next(Frame& frame) override;
  /// Renders the scene at time index / rate_hz from a camera that stands still. Does not affect next().
  void look(std::int64_t index, const Eigen::Isometry3d& T_world_camera, Frame& frame);
  bool rewind() override;
  bool seek(std::int64_t index) override;
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override;
  [[nodiscard]] std::string name() const override;

  [[nodiscard]] const SimTruth& truth() const;  ///< Returns the ground truth of the last frame.
  [[nodiscard]] const Room& room() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
