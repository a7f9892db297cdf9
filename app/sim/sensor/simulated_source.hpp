// simulated_source.hpp: a Kinect in a room made in code, with the truth beside every frame.
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/frame_source.hpp"

namespace roomradar {

struct Room;

/// What the sensor would have delivered without its faults, for the frame filled last.
struct SimTruth {
  /// Exact depth of the pixel's centre ray, within the sensor's range; 0 = outside of it.
  DepthImage depth_m;
  MaskImage moved;  ///< 255 where the nearest surface is a moving thing
  /// 0 = the room, else 1 + the position of the mover in SimOptions::movers; past them the crate that came.
  MaskImage mover;
  MaskImage revealed;  ///< 255 where a crate that went would be the nearest surface
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
};

/// Frames of a simulated Kinect. Frame i depends on the options and i alone: rewinding or reading on gives
/// the same pixels. Room coordinates are the world: +z up, metres, floor at z = 0. A crate that comes or
/// goes is not among room()'s solids.
class SimulatedSource final : public FrameSource {
 public:
  /// Throws Error if the options are not valid.
  explicit SimulatedSource(const SimOptions& options);
  ~SimulatedSource() override;

  ReadResult next(Frame& frame) override;
  /// The frame of that index (any, of time index / rate) as a camera at another pose takes it; `next` goes on
  /// where it was.
  void look(std::int64_t index, const Eigen::Isometry3d& T_world_camera, Frame& frame);
  bool rewind() override;
  bool seek(std::int64_t index) override;
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override;
  [[nodiscard]] std::string name() const override;

  [[nodiscard]] const SimTruth& truth() const;  ///< of the frame that was filled last
  [[nodiscard]] const Room& room() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roomradar
