// read_ahead_test.cpp: a source that is read one frame ahead delivers what it delivers by itself.
#include "app/sources/recordings/read_ahead.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar::read_ahead_test {
namespace {

/// What the source was asked to do, readable while another thread reads it.
struct Calls {
  std::atomic<int> started = 0;  ///< calls of next() that began
};

/// Frames 0 to 5. Frame 1 is unreadable; with `faulty`, frame 3 throws once.
class SixFrames final : public FrameSource {
 public:
  SixFrames(Calls& calls, bool jumps, bool faulty) : calls_(calls), jumps_(jumps), faulty_(faulty) {}

  ReadResult next(Frame& frame) override {
    ++calls_.started;
    if (next_ == 6) return {ReadStatus::kEnd, {}};
    const int index = next_++;
    if (index == 3 && std::exchange(faulty_, false)) throw Error("frame 3 cannot be read");
    if (index == 1) return {ReadStatus::kSkipped, "frame 1"};
    frame.index = index;
    frame.depth_m = DepthImage(2, 1, static_cast<float>(index));
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override { return seek(0); }
  bool seek(std::int64_t index) override {
    if (jumps_) next_ = static_cast<int>(index);
    return jumps_;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return 6; }
  [[nodiscard]] std::string name() const override { return "six"; }

 private:
  Calls& calls_;
  bool jumps_;
  bool faulty_;
  int next_ = 0;
};

class ReadAhead : public ::testing::Test {
 protected:
  Calls calls_;
  Frame frame_;

  std::unique_ptr<FrameSource> six(bool jumps = true, bool faulty = false) {
    return read_ahead(std::make_unique<SixFrames>(calls_, jumps, faulty));
  }
  /// Reads one result: the frame's index, -1 for a skipped frame, -2 at the end.
  int read(FrameSource& source) {
    const ReadResult result = source.next(frame_);
    if (result.status == ReadStatus::kEnd) return -2;
    if (result.status == ReadStatus::kSkipped) return -1;
    EXPECT_EQ(frame_.depth_m.at(1, 0), static_cast<float>(frame_.index));  // image and index belong together
    return static_cast<int>(frame_.index);
  }
  std::vector<int> read(FrameSource& source, int count) {
    std::vector<int> results;
    for (int i = 0; i < count; ++i) results.push_back(read(source));
    return results;
  }
  /// Waits until that many calls of next() have reached the source itself.
  bool reaches(int calls) {
    for (int i = 0; i < 2000 && calls_.started < calls; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return calls_.started >= calls;
  }
};

TEST_F(ReadAhead, DeliversTheSameResultsInTheSameOrder) {
  const auto source = six();
  EXPECT_EQ(read(*source, 8), (std::vector<int>{0, -1, 2, 3, 4, 5, -2, -2}));
  EXPECT_EQ(source->frame_count(), 6);
  EXPECT_EQ(source->name(), "six");
}

TEST_F(ReadAhead, ReadsOneFrameAheadInSequenceAndNoneAfterAJump) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "one processor: nothing is read ahead";
  const auto source = six();
  EXPECT_EQ(read(*source), 0);
  EXPECT_EQ(calls_.started, 1);  // a caller that seeks next has nothing to wait for
  EXPECT_EQ(read(*source), -1);
  EXPECT_TRUE(reaches(3));  // frame 2, while the caller uses frame 1
  EXPECT_TRUE(source->seek(4));
  EXPECT_EQ(read(*source), 4);
  EXPECT_EQ(calls_.started, 4);
}

TEST_F(ReadAhead, ARewindOrASeekDiscardsTheFrameThatWasReadAhead) {
  const auto source = six();
  EXPECT_EQ(read(*source, 3), (std::vector<int>{0, -1, 2}));
  EXPECT_TRUE(source->rewind());
  EXPECT_EQ(read(*source, 4), (std::vector<int>{0, -1, 2, 3}));
  EXPECT_TRUE(source->seek(2));
  EXPECT_EQ(read(*source, 5), (std::vector<int>{2, 3, 4, 5, -2}));
  EXPECT_TRUE(source->rewind());
  EXPECT_EQ(read(*source), 0);
}

TEST_F(ReadAhead, ASourceThatCannotJumpLosesNoFrame) {
  const auto source = six(/*jumps=*/false);
  EXPECT_EQ(read(*source, 3), (std::vector<int>{0, -1, 2}));
  EXPECT_FALSE(source->rewind());
  EXPECT_FALSE(source->seek(5));
  EXPECT_EQ(read(*source, 4), (std::vector<int>{3, 4, 5, -2}));
}

TEST_F(ReadAhead, AFaultIsThrownWhereItsFrameWouldBeAndReadingGoesOn) {
  const auto source = six(/*jumps=*/true, /*faulty=*/true);
  EXPECT_EQ(read(*source, 3), (std::vector<int>{0, -1, 2}));
  EXPECT_THROW(read(*source), Error);
  EXPECT_EQ(read(*source, 3), (std::vector<int>{4, 5, -2}));
}

TEST_F(ReadAhead, TheFrameAtTheEndStaysAsItIs) {
  const auto source = six();
  read(*source, 6);
  EXPECT_EQ(read(*source), -2);
  EXPECT_EQ(frame_.index, 5);
  EXPECT_EQ(frame_.depth_m.at(0, 0), 5.0F);
}

}  // namespace
}  // namespace roomradar::read_ahead_test
