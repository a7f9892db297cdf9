// trade_frames.cpp: reads the frames of a recording.
#include "app/evaluation/trade/trade_frames.hpp"

#include <algorithm>

#include "app/cli/open_source.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

std::vector<Frame> frames_of_recording(const std::string& folder, std::int64_t count) {
  const std::unique_ptr<FrameSource> source = open_source(folder, {});
  std::vector<Frame> frames;
  Frame frame;
  for (std::int64_t i = 0; i < count; ++i) {
    const ReadResult read = source->next(frame);
    if (read.status == ReadStatus::kEnd) break;
    if (read.status == ReadStatus::kFrame) frames.push_back(frame);
  }
  if (frames.size() < kFewestTradeFrames)
    throw Error(folder + ": of the first " + std::to_string(count) + " frames " +
                std::to_string(frames.size()) + " are readable; at least " +
                std::to_string(kFewestTradeFrames) + " are needed");
  if (!std::all_of(frames.begin(), frames.end(), [](const Frame& f) { return f.T_world_camera.has_value(); }))
    throw Error(folder + ": not all frames have poses, so there is no truth to measure errors by");
  return frames;
}

}  // namespace roomradar
