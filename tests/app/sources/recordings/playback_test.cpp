// playback_test.cpp: sources that are held, rewound and looped.
#include "app/sources/recordings/playback_source.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace roomradar::playback_test {
namespace {

constexpr double kFrame_s = 1.0 / 30.0;

/// Frames 0 to count - 1, a tenth of a second apart, starting at 5 s; frame 1 is unreadable.
class NumberedSource final : public FrameSource {
 public:
  NumberedSource(int count, bool rewinds) : count_(count), rewinds_(rewinds) {}
  ReadResult next(Frame& frame) override {
    if (next_ == count_) return {ReadStatus::kEnd, {}};
    const int index = next_++;
    if (index == 1) return {ReadStatus::kSkipped, "frame 1"};
    frame.index = index;
    frame.stamp_s = 5.0 + 0.1 * index;
    frame.depth_m = DepthImage(1, 1, static_cast<float>(index));
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    if (rewinds_) next_ = 0;
    return rewinds_;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return count_; }
  [[nodiscard]] std::string name() const override { return "numbers"; }

 private:
  int count_;
  bool rewinds_;
  int next_ = 0;
};

PlaybackSource numbers(int count, AtEnd at_end, bool rewinds = true) {
  return {std::make_unique<NumberedSource>(count, rewinds), at_end};
}

struct Seen {
  std::int64_t index;
  double stamp_s;
};

/// Reads the next readable frame.
Seen next_of(PlaybackSource& source, Frame& frame) {
  ReadResult result = source.next(frame);
  if (result.status == ReadStatus::kSkipped) result = source.next(frame);
  EXPECT_EQ(result.status, ReadStatus::kFrame);
  EXPECT_EQ(frame.depth_m.at(0, 0), static_cast<float>(frame.index));  // images match their index
  return {frame.index, frame.stamp_s};
}

TEST(PlaybackSource, PassesASourceOnAsItIs) {
  PlaybackSource source = numbers(3, AtEnd::kEnd);
  Frame frame;
  EXPECT_EQ(next_of(source, frame).stamp_s, 5.0);
  EXPECT_EQ(next_of(source, frame).stamp_s, 5.2);
  EXPECT_EQ(source.next(frame).status, ReadStatus::kEnd);
  EXPECT_EQ(source.next(frame).status, ReadStatus::kEnd);
  EXPECT_EQ(source.frame_count(), 3);
}

TEST(PlaybackSource, AHeldFrameStaysWhileTimeGoesOnAndWhatFollowsIsLaterByThat) {
  PlaybackSource source = numbers(4, AtEnd::kEnd);
  Frame frame;
  next_of(source, frame);
  source.hold(true);
  for (int i = 1; i <= 30; ++i) {
    const Seen held = next_of(source, frame);
    EXPECT_EQ(held.index, 0);
    EXPECT_NEAR(held.stamp_s, 5.0 + i * kFrame_s, 1e-12);
    EXPECT_TRUE(source.is_repeating());
  }
  source.hold(false);
  Seen after = next_of(source, frame);
  EXPECT_EQ(after.index, 2);
  EXPECT_NEAR(after.stamp_s, 5.0 + 31 * kFrame_s, 1e-12);
  EXPECT_FALSE(source.is_repeating());
  after = next_of(source, frame);
  EXPECT_NEAR(after.stamp_s, 5.1 + 31 * kFrame_s, 1e-12);
}

TEST(PlaybackSource, TimeDoesNotGoOnTwiceWhereADevicesClockDoesWhileItsFrameIsHeld) {
  // Frame 2 is 0.2 s after frame 0, as from a device whose frames in between were not read.
  PlaybackSource source = numbers(4, AtEnd::kEnd);
  Frame frame;
  next_of(source, frame);
  source.hold(true);
  for (int i = 0; i < 5; ++i) next_of(source, frame);
  source.hold(false);
  EXPECT_NEAR(next_of(source, frame).stamp_s, 5.2, 1e-12);
  EXPECT_NEAR(next_of(source, frame).stamp_s, 5.3, 1e-12);
}

TEST(PlaybackSource, TimeStandsStillInAPauseThoughADevicesClockGoesOn) {
  PlaybackSource source = numbers(6, AtEnd::kEnd);
  Frame frame;
  const double before_s = next_of(source, frame).stamp_s;
  // The next two are 0.2 and 0.3 s later by the source's clock.
  source.resume();
  EXPECT_NEAR(next_of(source, frame).stamp_s, before_s + kFrame_s, 1e-12);
  EXPECT_NEAR(next_of(source, frame).stamp_s, before_s + 2 * kFrame_s, 1e-12);
  EXPECT_NEAR(next_of(source, frame).stamp_s, before_s + 2 * kFrame_s + 0.1, 1e-12);
}

/// Frames a thirtieth of a second apart; from frame `fresh` on they are a minute later, as from a device
/// whose first `fresh` frames wait in a spool.
class DeviceSource final : public FrameSource {
 public:
  explicit DeviceSource(int fresh) : fresh_(fresh) {}
  ReadResult next(Frame& frame) override {
    frame.index = next_++;
    frame.stamp_s = static_cast<double>(frame.index) * kFrame_s + (frame.index >= fresh_ ? 60.0 : 0.0);
    frame.depth_m = DepthImage(1, 1, static_cast<float>(frame.index));
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    next_ = 0;
    return true;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string name() const override { return "a device"; }

 private:
  std::int64_t fresh_, next_ = 0;
};

TEST(PlaybackSource, FramesThatWaitedInASpoolDoNotBringThePauseBack) {
  PlaybackSource source(std::make_unique<DeviceSource>(5), AtEnd::kEnd);
  Frame frame;
  for (int i = 0; i < 3; ++i) next_of(source, frame);
  source.resume();
  for (int i = 3; i < 9; ++i) EXPECT_NEAR(next_of(source, frame).stamp_s, i * kFrame_s, 1e-9) << i;
}

TEST(PlaybackSource, FramesThatWaitedInASpoolDoNotBringTheTimeOfAHoldTwice) {
  PlaybackSource source(std::make_unique<DeviceSource>(5), AtEnd::kEnd);
  Frame frame;
  for (int i = 0; i < 3; ++i) next_of(source, frame);
  source.hold(true);
  for (int i = 0; i < 1800; ++i) next_of(source, frame);  // one minute
  source.hold(false);
  for (int i = 3; i < 9; ++i) EXPECT_NEAR(next_of(source, frame).stamp_s, 60.0 + i * kFrame_s, 1e-9) << i;
}

TEST(PlaybackSource, WhatADeviceSentSinceARewindFollowsOnWhatWasShownAgain) {
  PlaybackSource source(std::make_unique<DeviceSource>(1802), AtEnd::kEnd);
  Frame frame;
  for (int i = 0; i < 1800; ++i) next_of(source, frame);
  ASSERT_TRUE(source.rewind());  // a minute to show again, while the device continues
  for (int i = 0; i < 1840; ++i)
    ASSERT_NEAR(next_of(source, frame).stamp_s, (1800 + i) * kFrame_s, 1e-6) << i;
}

TEST(PlaybackSource, SaysWhichFramesHadBeenThereBefore) {
  PlaybackSource source = numbers(6, AtEnd::kStay);
  Frame frame;
  const auto is_again = [&] {
    next_of(source, frame);
    return source.is_again();
  };
  EXPECT_FALSE(is_again());  // 0
  EXPECT_FALSE(is_again());  // 2
  source.hold(true);
  EXPECT_TRUE(is_again());
  source.hold(false);
  EXPECT_FALSE(is_again());  // 3
  ASSERT_TRUE(source.rewind());
  for (const int index : {0, 2, 3}) {
    EXPECT_TRUE(is_again()) << index;
    EXPECT_EQ(frame.index, index);
  }
  EXPECT_FALSE(is_again());  // 4
  EXPECT_FALSE(is_again());  // 5
  EXPECT_TRUE(is_again()) << "the last one stays";
}

TEST(PlaybackSource, NothingIsHeldBeforeThereIsAFrame) {
  PlaybackSource source = numbers(3, AtEnd::kStay);
  source.hold(true);
  Frame frame;
  EXPECT_EQ(next_of(source, frame).index, 0);
}

TEST(PlaybackSource, StaysWithTheLastFrame) {
  PlaybackSource source = numbers(3, AtEnd::kStay);
  Frame frame;
  next_of(source, frame);
  next_of(source, frame);
  for (int i = 1; i <= 100; ++i) {
    const Seen stayed = next_of(source, frame);
    EXPECT_EQ(stayed.index, 2);
    EXPECT_NEAR(stayed.stamp_s, 5.2 + i * kFrame_s, 1e-9);
  }
  EXPECT_EQ(source.frame_count(), std::nullopt);
}

TEST(PlaybackSource, LoopsAndRewindsWithStampsThatGoOn) {
  PlaybackSource source = numbers(3, AtEnd::kLoop);
  Frame frame;
  double last_s = 0.0;
  std::vector<std::int64_t> indices;
  for (int i = 0; i < 7; ++i) {
    if (i == 3) {
      EXPECT_TRUE(source.rewind());  // after 0 2 0
    }
    const Seen seen = next_of(source, frame);
    EXPECT_GT(seen.stamp_s, last_s);
    EXPECT_LT(seen.stamp_s, i == 0 ? 5.1 : last_s + 0.21);
    last_s = seen.stamp_s;
    indices.push_back(seen.index);
  }
  EXPECT_EQ(indices, (std::vector<std::int64_t>{0, 2, 0, 0, 2, 0, 2}));
}

TEST(PlaybackSource, ADeviceThatCannotGoBackStays) {
  PlaybackSource source = numbers(1, AtEnd::kLoop, /*rewinds=*/false);
  Frame frame;
  next_of(source, frame);
  EXPECT_FALSE(source.rewind());
  EXPECT_NEAR(next_of(source, frame).stamp_s, 5.0 + kFrame_s, 1e-12);
}

TEST(PlaybackSource, AnEmptySourceEndsWhateverIsAskedFor) {
  for (const AtEnd at_end : {AtEnd::kEnd, AtEnd::kStay, AtEnd::kLoop}) {
    PlaybackSource source = numbers(0, at_end);
    Frame frame;
    EXPECT_EQ(source.next(frame).status, ReadStatus::kEnd);
  }
}

}  // namespace
}  // namespace roomradar::playback_test
