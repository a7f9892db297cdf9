// trade_frames.hpp: the frames on which a setting is measured: their number and size, from a recording, in
// memory.
#pragma once
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/frame.hpp"
#include "mapping/types/frame_source.hpp"
#include "mapping/types/system/stage_times.hpp"

namespace roomradar {

/// Image sizes and numbers of frames for one measurement of a setting.
struct TradeScale {
  int scan_px = 640;  ///< width of the simulated 4:3 depth images of scans
  int scan_frames = 75;
  double scan_rate_hz = 15.0;  ///< half a Kinect's rate, for fewer frames on the same camera path
  int map_frames = 240;        ///< number of frames of the prescan from which a run's map is made
  int run_px = 640;            ///< width of the images of the run and of its prescan
  int run_frames = 120;
  int scenarios = 24;  ///< number of drops and pushes onto hidden surfaces
};

/// Scale for functional tests, not for choosing presets. A sweep with small images takes a few minutes.
inline constexpr TradeScale kQuickScale{.scan_px = 320,
                                        .scan_frames = 30,
                                        .scan_rate_hz = 15.0,
                                        .map_frames = 120,
                                        .run_px = 320,
                                        .run_frames = 60,
                                        .scenarios = 8};

/// Min number of readable frames of a recording.
inline constexpr std::size_t kFewestTradeFrames = 30;

/// Returns the readable frames among the first `count` frames of a recording. Throws Error if the recording
/// cannot be read, fewer than kFewestTradeFrames frames are readable, or a frame has no pose. The poses serve
/// as ground truth.
std::vector<Frame> frames_of_recording(const std::string& folder, std::int64_t count);

/// Frame source in memory, so that measurements exclude the time of reading or rendering frames.
class KeptFrames final : public FrameSource {
 public:
  /// `frames` must outlive this object.
  KeptFrames(const std::vector<Frame>& frames, std::string name) : frames_(frames), name_(std::move(name)) {}

  ReadResult next(Frame& frame) override {
    if (position_ == frames_.size()) return {ReadStatus::kEnd, {}};
    const auto start = std::chrono::steady_clock::now();
    frame = frames_[position_++];
    spent_ms_ += ms_since(start);
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    position_ = 0;
    return true;
  }
  bool seek(std::int64_t index) override {
    if (index < 0 || index >= std::ssize(frames_)) return false;
    position_ = static_cast<std::size_t>(index);
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::ssize(frames_); }
  [[nodiscard]] std::string name() const override { return name_; }
  /// Returns the total time spent copying frames, ms.
  [[nodiscard]] double spent_ms() const { return spent_ms_; }

 private:
  const std::vector<Frame>& frames_;
  std::string name_;
  std::size_t position_ = 0;
  double spent_ms_ = 0.0;
};

}  // namespace roomradar
