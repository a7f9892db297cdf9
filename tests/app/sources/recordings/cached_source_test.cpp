// cached_source_test.cpp: a cached source delivers the frames of its source, and takes each of them once.
#include "app/sources/recordings/cached_source.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/sim/sensor/simulated_source.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::cached_source_test {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 4;

SimOptions small_room() {
  SimOptions options;
  options.frames = kFrames;
  options.depth_camera = {80, 60, 73.0, 73.0, 39.5, 29.5};
  return options;
}

/// The simulated Kinect, which counts the frames that it renders.
class CountedSource final : public FrameSource {
 public:
  explicit CountedSource(int& rendered) : source_(small_room()), rendered_(rendered) {}
  ReadResult next(Frame& frame) override {
    const ReadResult result = source_.next(frame);
    rendered_ += result.status == ReadStatus::kFrame;
    return result;
  }
  bool rewind() override { return source_.rewind(); }
  bool seek(std::int64_t index) override { return source_.seek(index); }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return source_.frame_count(); }
  [[nodiscard]] std::string name() const override { return source_.name(); }

 private:
  SimulatedSource source_;
  int& rendered_;
};

/// Sets TMPDIR to a folder of the test's own.
class CachedSource : public ::testing::Test {
 protected:
  CachedSource() { setenv("TMPDIR", folder_.path().c_str(), 1); }
  ~CachedSource() override {
    if (before_)
      setenv("TMPDIR", before_->c_str(), 1);
    else
      unsetenv("TMPDIR");
  }

  std::unique_ptr<FrameSource> cached(std::uintmax_t max_bytes = kMaxFrameCache_bytes) {
    return cache_frames(std::make_unique<CountedSource>(rendered_), max_bytes);
  }
  /// Reads to the end, and compares all with a source of its own, image by image.
  static void expect_all_from(FrameSource& source, std::int64_t first) {
    SimulatedSource expected(small_room());
    ASSERT_TRUE(expected.seek(first));
    Frame frame, wanted;
    for (std::int64_t index = first; index < kFrames; ++index) {
      ASSERT_EQ(source.next(frame).status, ReadStatus::kFrame) << index;
      ASSERT_EQ(expected.next(wanted).status, ReadStatus::kFrame);
      EXPECT_EQ(frame.index, index);
      EXPECT_EQ(frame.stamp_s, wanted.stamp_s);
      EXPECT_EQ(frame.depth_m.pixels, wanted.depth_m.pixels) << index;
      EXPECT_EQ(frame.colour.pixels, wanted.colour.pixels) << index;
      EXPECT_TRUE(frame.T_world_camera->isApprox(*wanted.T_world_camera, 0.0)) << index;
    }
    EXPECT_EQ(source.next(frame).status, ReadStatus::kEnd);
  }

  std::optional<std::string> before_ =
      getenv("TMPDIR") ? std::optional<std::string>(getenv("TMPDIR")) : std::nullopt;
  test::TemporaryFolder folder_;
  int rendered_ = 0;
};

TEST_F(CachedSource, RendersEachFrameOnce) {
  {
    const auto source = cached();
    expect_all_from(*source, 0);
    ASSERT_TRUE(source->rewind());
    expect_all_from(*source, 0);
    ASSERT_TRUE(source->seek(2));
    expect_all_from(*source, 2);
    EXPECT_EQ(rendered_, kFrames);
    EXPECT_FALSE(fs::is_empty(folder_.path()));
  }
  EXPECT_TRUE(fs::is_empty(folder_.path())) << "the cache is removed";
}

TEST_F(CachedSource, SeeksFramesThatAreNotCachedYet) {
  const auto source = cached();
  ASSERT_TRUE(source->seek(2));
  expect_all_from(*source, 2);
  ASSERT_TRUE(source->rewind());
  expect_all_from(*source, 0);
  EXPECT_EQ(rendered_, kFrames);
  EXPECT_FALSE(source->seek(kFrames));
  EXPECT_FALSE(source->seek(-1));
}

TEST_F(CachedSource, FramesThatDoNotFitAreRenderedAgain) {
  constexpr std::uintmax_t kFrame_bytes = 80 * 60 * (sizeof(float) + 3);
  const auto source = cached(2 * kFrame_bytes);
  expect_all_from(*source, 0);
  ASSERT_TRUE(source->rewind());
  expect_all_from(*source, 0);
  EXPECT_EQ(rendered_, 2 * kFrames - 2);
}

TEST_F(CachedSource, ClearedFolderCostsOnlyTime) {
  const auto source = cached();
  expect_all_from(*source, 0);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path())) fs::remove_all(entry);
  ASSERT_TRUE(source->rewind());
  expect_all_from(*source, 0);
  EXPECT_EQ(rendered_, 2 * kFrames);
}

TEST_F(CachedSource, WithoutAFolderForTemporaryFilesTheSourceIsReturned) {
  setenv("TMPDIR", (folder_.path() / "absent").c_str(), 1);
  const auto source = cached();
  expect_all_from(*source, 0);
  ASSERT_TRUE(source->rewind());
  expect_all_from(*source, 0);
  EXPECT_EQ(rendered_, 2 * kFrames);
}

}  // namespace
}  // namespace roomradar::cached_source_test
