// deskewed_source.hpp: corrects rolling shutter and colour delay of a source's frames, from known camera
// poses.
#pragma once
#include <map>
#include <vector>

#include "mapping/alignment/rolling_shutter.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// Delivers the frames of another source, corrected for the camera's motion. Depth is as a global shutter
/// would have seen it at the middle of the readout. T_colour_depth accounts for the delay of the colour
/// image. Frames without neighbours of known pose are unchanged. Depth is also unchanged if no row would move
/// by more than about half a pixel. The other source must outlive this one.
class DeskewedSource final : public WrappedSource {
 public:
  /// @param trajectory  poses in the order of their stamps
  DeskewedSource(FrameSource& source, const std::vector<TimedPose>& trajectory, const SensorTiming& timing);

  ReadResult next(Frame& frame) override;

 private:
  SensorTiming timing_;
  std::map<std::int64_t, CameraVelocity> velocities_;  ///< by frame index
  Image<float> inverse_depth_per_m_, no_intensity_;
};

}  // namespace roomradar
