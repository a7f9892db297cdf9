// deskewed_source.hpp: frames of a source as a global shutter would have seen them, by the camera's known
// motion.
#pragma once
#include <map>
#include <vector>

#include "mapping/alignment/rolling_shutter.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// Delivers the frames of another source with their depth moved to the middle of its readout, and with the
/// colour camera where it was when the colour image was taken. Frames whose neighbours have no pose stay as
/// they are. All else is the other source's, which must outlive this one.
class DeskewedSource final : public FrameSource {
 public:
  /// @param trajectory  poses in the order of their stamps
  DeskewedSource(FrameSource& source, const std::vector<TimedPose>& trajectory, const SensorTiming& timing);

  ReadResult next(Frame& frame) override;
  bool rewind() override { return source_.rewind(); }
  bool seek(std::int64_t index) override { return source_.seek(index); }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return source_.frame_count(); }
  [[nodiscard]] std::string name() const override { return source_.name(); }

 private:
  FrameSource& source_;
  SensorTiming timing_;
  std::map<std::int64_t, CameraVelocity> velocities_;  ///< by frame index
  Image<float> inverse_depth_per_m_, no_intensity_;
};

}  // namespace roomradar
