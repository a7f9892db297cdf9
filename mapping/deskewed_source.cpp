// deskewed_source.cpp: velocities from the poses of neighbouring frames, and the correction of each frame.
#include "mapping/deskewed_source.hpp"

#include <algorithm>

#include "mapping/alignment/align.hpp"
#include "mapping/types/linear_algebra.hpp"

namespace roomradar {
namespace {

constexpr double kLeast_px = 0.5;  // max motion of a row that is not worth resampling the image

void invert(Image<float>& image) {
  for (float& value : image.pixels) value = value > 0.0F ? 1.0F / value : 0.0F;
}

}  // namespace

DeskewedSource::DeskewedSource(FrameSource& source, const std::vector<TimedPose>& trajectory,
                               const SensorTiming& timing)
    : WrappedSource(source), timing_(timing) {
  for (std::size_t i = 1; i + 1 < trajectory.size(); ++i) {
    const TimedPose &before = trajectory[i - 1], &after = trajectory[i + 1];
    velocities_[trajectory[i].frame_index] =
        velocity_of(before.T_world_camera.inverse() * after.T_world_camera, after.stamp_s - before.stamp_s);
  }
}

ReadResult DeskewedSource::next(Frame& frame) {
  const ReadResult result = source_.next(frame);
  const auto found = velocities_.find(frame.index);
  if (result.status != ReadStatus::kFrame || found == velocities_.end()) return result;
  const CameraVelocity& velocity = found->second;
  const double delay_s = frame.colour_after_depth_s + timing_.colour_delay_s;
  Vector6d twist;
  twist << velocity.linear_mps, velocity.angular_radps;
  frame.T_colour_depth = frame.T_colour_depth * retract(-delay_s * twist);
  if (!(0.5 * timing_.depth_readout_s * image_speed_pxps(velocity, frame.depth_camera) > kLeast_px))
    return result;
  std::swap(inverse_depth_per_m_, frame.depth_m);
  invert(inverse_depth_per_m_);
  deskew(frame.depth_camera, velocity, timing_.depth_readout_s, inverse_depth_per_m_, no_intensity_);
  invert(inverse_depth_per_m_);
  std::swap(inverse_depth_per_m_, frame.depth_m);
  return result;
}

}  // namespace roomradar
