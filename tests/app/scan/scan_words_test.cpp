// scan_words_test.cpp: each fault of a scan is provoked, and its sentence comes within half a second; a good
// scan has none.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "app/scan/scan_view.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "app/sources/recordings/folder_source.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/recordings.hpp"

namespace roomradar::scan_words_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// What the window of a scan says, frame by frame.
class Watched {
 public:
  std::optional<ScanFault> say(const Frame& frame) {
    std::this_thread::sleep_for(std::chrono::milliseconds(3));  // the view is done with the frame before
    view_.after_frame(frame, odometry_.track(frame), odometry_, {});
    const auto start = std::chrono::steady_clock::now();
    while (!channel_.take(shown_) && std::chrono::steady_clock::now() - start < std::chrono::seconds(5))
      std::this_thread::yield();
    EXPECT_EQ(shown_.frame_index, frame.index);
    if (shown_.fault) ++frames_with[*shown_.fault];
    ++frames;
    return shown_.fault;
  }
  std::map<ScanFault, int> frames_with;
  int frames = 0;

 private:
  ScanChannel channel_;
  ShownScan shown_;
  Odometry odometry_;
  ScanView view_{channel_};
};

std::vector<Frame> frames_of(const std::string& spec) {
  SimulatedSource source(parse_sim_spec(spec));
  std::vector<Frame> frames;
  for (Frame frame; source.next(frame).status == ReadStatus::kFrame;) frames.push_back(frame);
  return frames;
}

/// Good frames, then 0.5 s of frames that `spoil` changes. Returns whether the fault's sentence came.
template <typename Spoil>
bool comes(ScanFault fault, const Spoil& spoil) {
  Watched watched;
  std::vector<Frame> frames = frames_of("sim:table?seed=3&frames=36&width=160");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (i >= 20) spoil(frames[i]);
    const std::optional<ScanFault> said = watched.say(frames[i]);
    if (i < 20 && said) ADD_FAILURE() << to_sentence(*said) << " in good frame " << i;
    if (said == fault) return true;
  }
  return false;
}

TEST(ScanWords, Lost) {
  EXPECT_TRUE(comes(ScanFault::kLost, [](Frame& frame) {  // another place
    for (float& depth_m : frame.depth_m.pixels) depth_m = depth_m > 0.0F ? 1.0F + 0.3F * depth_m : 0.0F;
    std::reverse(frame.colour.pixels.begin(), frame.colour.pixels.end());
  }));
}

TEST(ScanWords, TooNear) {
  EXPECT_TRUE(
      comes(ScanFault::kTooNear, [](Frame& frame) {  // nearer than its range a Kinect measures nothing
        for (std::size_t i = 0; i < frame.depth_m.pixels.size(); ++i)
          frame.depth_m.pixels[i] = i % 5 == 0 ? 0.52F : 0.0F;
      }));
}

TEST(ScanWords, TooFar) {
  EXPECT_TRUE(comes(ScanFault::kTooFar, [](Frame& frame) {
    for (float& depth_m : frame.depth_m.pixels) depth_m = depth_m > 0.0F ? depth_m + 3.5F : 0.0F;
  }));
}

TEST(ScanWords, TooDark) {
  EXPECT_TRUE(comes(ScanFault::kTooDark, [](Frame& frame) {
    for (Rgb& pixel : frame.colour.pixels)
      pixel = {static_cast<std::uint8_t>(pixel.r / 16), static_cast<std::uint8_t>(pixel.g / 16),
               static_cast<std::uint8_t>(pixel.b / 16)};
  }));
}

TEST(ScanWords, OneWallOnly) {
  // A plain wall: from frame to frame the camera moves along it.
  const test::Scene wall = test::plane({0, 1, 0}, 2.0);
  constexpr Intrinsics kCamera{160, 120, 146.0, 146.0, 79.5, 59.5};
  Watched watched;
  bool came = false;
  for (int i = 0; i < 16; ++i) {
    Frame frame = test::exact_frame(wall, kCamera, test::looking_at({0.01 * i, 0, 1}, {0.01 * i, 2, 1}));
    frame.index = i;
    frame.stamp_s = i / 30.0;
    came = came || watched.say(frame) == ScanFault::kOneWall;
  }
  EXPECT_TRUE(came);
}

TEST(ScanWords, TooFast) {
  // The same walk, three times as fast.
  std::vector<Frame> frames = frames_of("sim:table?seed=3&frames=60&width=160");
  Watched watched;
  bool came = false;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].stamp_s = static_cast<double>(i) / 90.0;
    came = came || watched.say(frames[i]) == ScanFault::kTooFast;
  }
  EXPECT_TRUE(came);
}

TEST(ScanWords, SomethingMoves) {
  Watched watched;
  for (const Frame& frame : frames_of("sim:table?seed=2&frames=150&width=160&moving=person&path=view"))
    static_cast<void>(watched.say(frame));
  EXPECT_GT(watched.frames_with[ScanFault::kMovement], 5);
}

TEST(ScanWords, NoneInAGoodScan) {
  Watched watched;
  for (const Frame& frame : frames_of("sim:table?seed=5&frames=60&width=160"))
    static_cast<void>(watched.say(frame));
  EXPECT_TRUE(watched.frames_with.empty());
}

TEST(ScanWords, HardlyAnyInKitchen) {
  ROOMRADAR_RECORDING_OR_SKIP(folder, "kitchen");
  const auto source = open_folder(folder);
  Watched watched;
  Frame frame;
  while (watched.frames < 300 && source->next(frame).status == ReadStatus::kFrame)
    static_cast<void>(watched.say(frame));
  int said = 0;
  for (const auto& [fault, frames] : watched.frames_with) {
    said += frames;
    std::printf("%d of %d frames: %s\n", frames, watched.frames, std::string(to_sentence(fault)).c_str());
  }
  EXPECT_LT(said, watched.frames / 20);
}

}  // namespace
}  // namespace roomradar::scan_words_test
