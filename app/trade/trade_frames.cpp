// trade_frames.cpp: what is read is checked, so that a sweep does not fail in its middle.
#include "app/trade/trade_frames.hpp"

#include <algorithm>

#include "app/open_source.hpp"
#include "mapping/types/error.hpp"

namespace roomradar {

Intrinsics kinect_of_width(int width_px) {
  Intrinsics camera = scaled(kKinectDepthCamera, width_px / 640.0);
  camera.width_px = width_px;
  camera.height_px = width_px * 3 / 4;
  return camera;
}

std::vector<Frame> frames_of_recording(const std::string& folder, std::int64_t first, std::int64_t count) {
  const std::unique_ptr<FrameSource> source = open_source(folder, FrameRange{first, first + count - 1});
  std::vector<Frame> frames;
  Frame frame;
  for (ReadResult read = source->next(frame); read.status != ReadStatus::kEnd; read = source->next(frame))
    if (read.status == ReadStatus::kFrame) frames.push_back(frame);
  const bool has_poses =
      std::all_of(frames.begin(), frames.end(), [](const Frame& f) { return f.T_world_camera.has_value(); });
  if (frames.size() < kFewestTradeFrames || !has_poses)
    throw Error(folder + ": frames " + std::to_string(first) + " to " + std::to_string(first + count - 1) +
                (has_poses ? ": are " + std::to_string(frames.size()) + " readable ones; at least " +
                                 std::to_string(kFewestTradeFrames) + " are needed"
                           : ": have no poses, so there is no truth to measure errors by"));
  return frames;
}

}  // namespace roomradar
