// chosen_frames_test.cpp: chosen frames come in order, from sources that seek and from those that cannot.
#include "mapping/revision/chosen_frames.hpp"

#include <gtest/gtest.h>

#include "mapping/types/system/error.hpp"

namespace roomradar::chosen_frames_test {
namespace {

/// Frames 0 to 7. Frame 2 is unreadable; frame `faulty` throws.
class EightFrames final : public FrameSource {
 public:
  explicit EightFrames(bool seeks, int faulty = -1) : seeks_(seeks), faulty_(faulty) {}

  ReadResult next(Frame& frame) override {
    if (next_ == 8) return {ReadStatus::kEnd, {}};
    const int index = next_++;
    ++reads;
    if (index == faulty_) throw Error("frame " + std::to_string(index) + " cannot be read");
    if (index == 2) return {ReadStatus::kSkipped, "frame 2"};
    frame.index = renamed == index ? 100 : index;
    return {ReadStatus::kFrame, {}};
  }
  bool rewind() override {
    next_ = 0;
    return rewinds;
  }
  bool seek(std::int64_t index) override {
    if (seeks_) next_ = static_cast<int>(index);
    return seeks_;
  }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return 8; }
  [[nodiscard]] std::string name() const override { return "eight"; }

  bool rewinds = true;
  int renamed = -1;  ///< this frame has another index than before
  int reads = 0;

 private:
  bool seeks_;
  int faulty_;
  int next_ = 5;
};

std::vector<FusedFrame> fused() {
  std::vector<FusedFrame> all;
  for (int i = 0; i < 8; ++i) all.push_back({i, i, {}, Eigen::Isometry3d::Identity()});
  return all;
}

/// Indices of the frames that are delivered.
std::vector<std::int64_t> delivered(FrameSource& source, std::vector<std::size_t> chosen) {
  const std::vector<FusedFrame> all = fused();
  StageTimes times;
  ChosenFrames frames(source, all, std::move(chosen), times);
  std::vector<std::int64_t> indices;
  Frame frame;
  for (std::size_t i = 0; frames.next(frame, i);) {
    EXPECT_EQ(frame.index, all[i].frame_index);
    indices.push_back(frame.index);
  }
  std::size_t none = 0;
  EXPECT_FALSE(frames.next(frame, none));  // it stays at the end
  return indices;
}

TEST(ChosenFrames, ComeInOrderAndThoseBetweenAreNotRead) {
  EightFrames source(/*seeks=*/true);
  EXPECT_EQ(delivered(source, {0, 3, 4, 7}), (std::vector<std::int64_t>{0, 3, 4, 7}));
  EXPECT_EQ(source.reads, 4);
}

TEST(ChosenFrames, ComeFromASourceThatCannotSeek) {
  EightFrames source(/*seeks=*/false);
  EXPECT_EQ(delivered(source, {1, 3, 6}), (std::vector<std::int64_t>{1, 3, 6}));
}

TEST(ChosenFrames, ThatAreUnreadableOrOthersThanBeforeAreLeftOut) {
  EightFrames source(/*seeks=*/true);
  source.renamed = 4;
  EXPECT_EQ(delivered(source, {1, 2, 4, 5}), (std::vector<std::int64_t>{1, 5}));
}

TEST(ChosenFrames, NoneAreNone) {
  EightFrames source(/*seeks=*/true);
  EXPECT_EQ(delivered(source, {}), std::vector<std::int64_t>());
  EXPECT_EQ(source.reads, 0);
}

TEST(ChosenFrames, AFaultOfTheSourceReachesTheCaller) {
  EightFrames source(/*seeks=*/true, /*faulty=*/3);
  const std::vector<FusedFrame> all = fused();
  StageTimes times;
  ChosenFrames frames(source, all, {1, 3, 5}, times);
  Frame frame;
  std::size_t i = 0;
  ASSERT_TRUE(frames.next(frame, i));
  EXPECT_EQ(frame.index, 1);
  EXPECT_THROW(frames.next(frame, i), Error);
}

TEST(ChosenFrames, ASourceThatCannotRewindIsNamed) {
  EightFrames source(/*seeks=*/true);
  source.rewinds = false;
  const std::vector<FusedFrame> all = fused();
  StageTimes times;
  try {
    const ChosenFrames frames(source, all, {1}, times);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "eight: cannot be read again");
  }
}

}  // namespace
}  // namespace roomradar::chosen_frames_test
