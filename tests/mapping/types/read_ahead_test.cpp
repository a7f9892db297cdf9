// read_ahead_test.cpp: frames come in order, each with what was prepared of it, and no more are read than
// asked for.
#include "mapping/types/read_ahead.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar::read_ahead_test {
namespace {

/// Frames 0, 1, ... without end. Frame 2 is unreadable, the source waits before frame 4, and frame `faulty`
/// throws.
class Endless final : public FrameSource {
 public:
  ReadResult next(Frame& frame) override {
    ++reads;
    if (next_ == 4 && !has_waited_) {
      has_waited_ = true;
      return {ReadStatus::kWaiting, "no frame yet"};
    }
    const std::int64_t index = next_++;
    if (index == faulty) throw Error("frame " + std::to_string(index) + " cannot be read");
    if (index == last + 1) return {};
    if (index == 2) return {ReadStatus::kSkipped, "frame 2"};
    frame.index = index;
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override { return false; }
  bool seek(std::int64_t index) override {
    if (can_seek) next_ = index;
    return can_seek;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
  [[nodiscard]] std::string name() const override { return "endless"; }

  int reads = 0;
  std::int64_t faulty = -1;
  std::int64_t last = 1000;
  bool can_seek = false;

 private:
  std::int64_t next_ = 0;
  bool has_waited_ = false;
};

/// Positions of the first frames of a source.
std::vector<std::int64_t> first(std::int64_t count) {
  std::vector<std::int64_t> positions(static_cast<std::size_t>(count));
  std::iota(positions.begin(), positions.end(), std::int64_t{0});
  return positions;
}

/// What is prepared of each frame here: ten times its index.
using Prepared = std::int64_t;
ReadAhead<Prepared> read_ahead(FrameSource& source, std::vector<std::int64_t> wanted) {
  return {source, 0, std::move(wanted),
          [](const Frame& frame, Prepared& prepared) { prepared = 10 * frame.index; }};
}

/// Indices of the delivered frames; -1: unreadable, -2: waiting.
std::vector<std::int64_t> delivered(FrameSource& source, std::int64_t count) {
  ReadAhead frames = read_ahead(source, first(count));
  std::vector<std::int64_t> indices;
  Frame frame;
  Prepared prepared = -1;
  for (;;) {
    const ReadResult result = frames.next(frame, prepared);
    if (result.status == ReadStatus::kEnd) return indices;
    if (result.status == ReadStatus::kFrame) {
      EXPECT_EQ(prepared, 10 * frame.index);
    }
    indices.push_back(result.status == ReadStatus::kFrame     ? frame.index
                      : result.status == ReadStatus::kWaiting ? -2
                                                              : -1);
  }
}

TEST(ReadAhead, DeliversFramesInOrder) {
  Endless source;
  EXPECT_EQ(delivered(source, 6), (std::vector<std::int64_t>{0, 1, -1, 3, -2, 4, 5}));
  EXPECT_EQ(source.reads, 7) << "the frames and the wait, and none beyond";
}

TEST(ReadAhead, ReadsNothingIfNoFramesAreWanted) {
  Endless source;
  EXPECT_TRUE(delivered(source, 0).empty());
  EXPECT_EQ(source.reads, 0);
}

TEST(ReadAhead, EndsWithTheSource) {
  Endless source;
  source.last = 1;
  EXPECT_EQ(delivered(source, 6), (std::vector<std::int64_t>{0, 1}));
}

TEST(ReadAhead, ErrorsComeAtTheirFrame) {
  Endless source;
  source.faulty = 1;
  ReadAhead frames = read_ahead(source, first(6));
  Frame frame;
  Prepared prepared = -1;
  EXPECT_EQ(frames.next(frame, prepared).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, 0);
  EXPECT_THROW((void)frames.next(frame, prepared), Error);
}

TEST(ReadAhead, ErrorsOfPreparingComeAtTheirFrame) {
  Endless source;
  ReadAhead<Prepared> frames(source, 0, first(6), [](const Frame& frame, Prepared&) {
    if (frame.index == 1) throw Error("frame 1 cannot be prepared");
  });
  Frame frame;
  Prepared prepared = -1;
  EXPECT_EQ(frames.next(frame, prepared).status, ReadStatus::kFrame);
  EXPECT_THROW((void)frames.next(frame, prepared), Error);
}

TEST(ReadAhead, DeliversTheWantedFramesOnlyWhetherTheSourceCanSeekOrNot) {
  for (const bool can_seek : {true, false}) {
    Endless source;
    source.can_seek = can_seek;
    ReadAhead frames = read_ahead(source, {1, 2, 5, 9});
    std::vector<std::int64_t> indices;
    Frame frame;
    Prepared prepared = -1;
    for (ReadResult result; (result = frames.next(frame, prepared)).status != ReadStatus::kEnd;) {
      if (result.status == ReadStatus::kWaiting) continue;
      indices.push_back(result.status == ReadStatus::kFrame ? frame.index : -1);
      EXPECT_TRUE(indices.back() == -1 || frames.position() == indices.back());
    }
    EXPECT_EQ(indices, (std::vector<std::int64_t>{1, -1, 5, 9})) << can_seek;
    EXPECT_EQ(source.reads, can_seek ? 4 : 11) << "of the source, with the wait before frame 4";
  }
}

TEST(ReadAhead, MayBeLeftWhileAFrameIsRead) {
  Endless source;
  Frame frame;
  Prepared prepared = -1;
  {
    ReadAhead frames = read_ahead(source, first(6));
    EXPECT_EQ(frames.next(frame, prepared).status, ReadStatus::kFrame);
  }
  EXPECT_EQ(source.reads, 2);
}

}  // namespace
}  // namespace roomradar::read_ahead_test
