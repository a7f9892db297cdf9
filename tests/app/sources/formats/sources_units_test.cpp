// sources_units_test.cpp: the Kinect's units, pairing of images, frame ranges, scratch folders, and spooling.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <fstream>
#include <future>
#include <limits>
#include <thread>

#include "app/sources/formats/frame_range.hpp"
#include "app/sources/formats/image_file.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "app/sources/formats/parse_numbers.hpp"
#include "app/sources/formats/scratch_folder.hpp"
#include "app/sources/formats/stamp_pairing.hpp"
#include "app/sources/recordings/frame_images.hpp"
#include "app/sources/recordings/spooled_source.hpp"
#include "mapping/types/codecs/png.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/app/sources/sources_support.hpp"
#include "tests/support/kept_source.hpp"

namespace roomradar::sources_units_test {
namespace {

using test::contains;
using test::error_of;
using test::MadeSource;
using test::read_all;

TEST(KinectUnits, RawDepthHasTheFormulasValues) {
  EXPECT_NEAR(raw_depth_m(500), 0.1236 * std::tan(500 / 2842.5 + 1.1863), 1e-6);
  EXPECT_EQ(raw_depth_m(kRawNoDepth), 0.0F);
}

TEST(KinectUnits, RawDepthRisesToItsEndAndIsNoneBeyond) {
  for (std::uint16_t raw = 1; raw <= kRawFarthest; ++raw)
    ASSERT_GT(raw_depth_m(raw), raw_depth_m(raw - 1)) << raw;
  EXPECT_LT(raw_depth_m(kRawFarthest), 10.0F);
  for (int raw = kRawFarthest + 1; raw <= 65535; ++raw)
    ASSERT_EQ(raw_depth_m(static_cast<std::uint16_t>(raw)), 0.0F) << raw;
}

TEST(KinectUnits, RawDepthComesBackFromItsMetres) {
  for (std::uint16_t raw = 0; raw <= kRawFarthest; ++raw) ASSERT_EQ(raw_from_depth_m(raw_depth_m(raw)), raw);
  for (const float none_m : {0.0F, 0.1F, 20.0F, -1.0F, std::nanf("")})
    EXPECT_EQ(raw_from_depth_m(none_m), kRawNoDepth);
}

TEST(KinectUnits, UprightCameraFeelsGravityAlongItsY) {
  const auto down = down_from_acceleration({0, 1, 0});
  ASSERT_TRUE(down);
  EXPECT_TRUE(down->isApprox(Eigen::Vector3d(0, 1, 0)));
}

TEST(KinectUnits, CameraThatLooksUpHasGravityBehindIt) {
  // The accelerometer's z axis points forward, and the camera looks up.
  const auto down = down_from_acceleration({0, 0.8, 0.6});
  ASSERT_TRUE(down);
  EXPECT_NEAR(down->z(), -0.6, 1e-12);
  EXPECT_TRUE(acceleration_at_rest_g(*down).isApprox(Eigen::Vector3d(0, 0.8, 0.6)));
}

TEST(KinectUnits, AccelerationOfAMovedDeviceIsNoGravity) {
  EXPECT_FALSE(down_from_acceleration({0, 0.7, 0}));
  EXPECT_FALSE(down_from_acceleration({0, 1.3, 0}));
  EXPECT_FALSE(down_from_acceleration({0, 0, 0}));
  EXPECT_FALSE(down_from_acceleration({0, std::nan(""), 0}));
}

TEST(KinectUnits, ClockGoesOnWhereTheStampsWrap) {
  KinectClock clock;
  const double before_s = clock.seconds(0xffffff00U);
  const double after_s = clock.seconds(0x100U);
  EXPECT_NEAR(after_s - before_s, 512 / 60e6, 1e-9);
  EXPECT_LT(clock.seconds(0xffffff00U), after_s);  // a step back is not taken for a wrap
}

TEST(ParseNumbers, TakesWholeWordsOnly) {
  EXPECT_EQ(parse_number("1.5e-3"), 1.5e-3);
  EXPECT_EQ(parse_number("+2"), 2.0);
  EXPECT_FALSE(parse_number("1.5x"));
  EXPECT_FALSE(parse_number(""));
  EXPECT_FALSE(parse_number("1,5"));
  EXPECT_TRUE(std::isnan(*parse_number("nan")));
  EXPECT_TRUE(std::isnan(*parse_number("-1.#IND000e+000")));
  EXPECT_TRUE(std::isnan(*parse_number("1.#QNAN")));
  EXPECT_EQ(parse_number("1.#INF00"), std::numeric_limits<double>::infinity());
  EXPECT_EQ(parse_number("-1.#INF"), -std::numeric_limits<double>::infinity());
  EXPECT_FALSE(parse_number("a#IND"));
  EXPECT_FALSE(parse_whole_number("3.0"));
  EXPECT_EQ(split_words(" a\tb  c\r").size(), 3U);
}

std::vector<DepthColourPair> take_all(StampPairing& pairing) {
  std::vector<DepthColourPair> pairs;
  while (const auto pair = pairing.take()) pairs.push_back(*pair);
  return pairs;
}

TEST(StampPairing, TakesTheNearerOfTheImagesBeforeAndAfter) {
  StampPairing pairing({});
  pairing.add_colour(0, 0.990);
  pairing.add_depth(0, 1.000);
  EXPECT_TRUE(take_all(pairing).empty());  // a nearer image may still arrive
  pairing.add_colour(1, 1.004);
  pairing.add_depth(1, 1.033);
  const auto pairs = take_all(pairing);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0].colour, 1);
  EXPECT_NEAR(pairs[0].colour_after_depth_s, 0.004, 1e-12);
}

TEST(StampPairing, OfAListTheLastDepthImageBeforeAGapKeepsItsColour) {
  for (const std::size_t kept : {kColoursKept, std::size_t{300}}) {
    StampPairing pairing({.colours_kept = kept});
    pairing.add_depth(0, 0.0);
    for (std::int64_t i = 0; i < 30; ++i) pairing.add_colour(i, 0.005 + static_cast<double>(i) / 30.0);
    pairing.add_depth(1, 1.0);
    const auto pair = pairing.take();
    ASSERT_TRUE(pair);
    EXPECT_EQ(pair->colour.has_value(), kept > kColoursKept);
    if (pair->colour) {
      EXPECT_EQ(*pair->colour, 0);
    }
  }
}

TEST(StampPairing, UsesEachImageOnceAndNoneThatIsTooFar) {
  StampPairing pairing({});
  pairing.add_colour(0, 1.005);
  pairing.add_depth(0, 1.001);
  pairing.add_depth(1, 1.010);
  pairing.add_colour(1, 1.0305);
  pairing.finish();
  const auto pairs = take_all(pairing);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].colour, 0);
  EXPECT_FALSE(pairs[1].colour);
}

TEST(StampPairing, DoesNotWaitWhereNothingNearerCanCome) {
  StampPairing pairing(kDevicePairing);
  pairing.add_colour(0, 0.990);
  pairing.add_depth(0, 1.000);
  EXPECT_EQ(take_all(pairing).size(), 1U);
}

TEST(StampPairing, DoesNotWaitPastTheNextDepthImage) {
  StampPairing pairing(kDevicePairing);
  pairing.add_depth(0, 1.000);
  pairing.add_depth(1, 1.033);
  const auto pairs = take_all(pairing);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_FALSE(pairs[0].colour);
}

TEST(StampPairing, ALostColourImageCostsOneFrameItsColourAndNoOther) {
  constexpr double kPeriod_s = 1.0 / 30.0;
  constexpr int kFrames = 12, kLost = 4;
  for (const PairingConfig& config : {kDevicePairing, PairingConfig{}})
    for (double phase_s = -0.016; phase_s < 0.0165; phase_s += 0.001) {
      StampPairing pairing(config);
      std::vector<DepthColourPair> pairs;
      for (int i = 0; i < kFrames; ++i) {
        const double stamp_s = 10.0 + i * kPeriod_s;
        const auto add_colour = [&] {
          if (i != kLost) pairing.add_colour(i, stamp_s + phase_s);
        };
        if (phase_s < 0.0) add_colour();
        pairing.add_depth(i, stamp_s);
        if (phase_s >= 0.0) add_colour();
        for (const DepthColourPair& pair : take_all(pairing)) pairs.push_back(pair);
        EXPECT_GE(pairs.size() + 2, static_cast<std::size_t>(i) + 1);  // none waits for more than one frame
      }
      pairing.finish();
      for (const DepthColourPair& pair : take_all(pairing)) pairs.push_back(pair);
      ASSERT_EQ(pairs.size(), static_cast<std::size_t>(kFrames));
      for (const DepthColourPair& pair : pairs) {
        EXPECT_EQ(pair.colour.has_value(), pair.depth != kLost) << phase_s;
        EXPECT_EQ(pair.colour.value_or(pair.depth), pair.depth) << phase_s;
      }
    }
}

TEST(StampPairing, SaysWhichStampsGoBack) {
  StampPairing pairing({});
  for (const auto& [number, stamp_s] : {std::pair(0, 1.0), {1, 0.5}, {2, 1.0}, {3, 1.1}})
    pairing.add_depth(number, stamp_s);
  pairing.finish();
  const auto pairs = take_all(pairing);
  ASSERT_EQ(pairs.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(pairs[i].stamp_goes_back, i == 1 || i == 2) << i;
}

TEST(FrameRange, ReadsTwoWholeNumbers) {
  const FrameRange range = parse_frame_range("400:499");
  EXPECT_EQ(range.first, 400);
  EXPECT_EQ(range.last, 499);
  for (const char* bad : {"", ":", "5", "5:", ":5", "-1:5", "5:4", "a:b", "1:2:3", "1.0:2", " 1:2"})
    EXPECT_TRUE(contains(error_of([&] { (void)parse_frame_range(bad); }), "400:499")) << bad;
}

TEST(FrameRange, IncludesBothEndsAndKeepsIndices) {
  for (const bool knows : {true, false}) {
    const auto source = limit_frames(std::make_unique<MadeSource>(10, knows, std::vector<int>{4}), 3, 6);
    const auto all = read_all(*source);
    ASSERT_EQ(all.frames.size(), 3U);
    EXPECT_EQ(all.frames.front().index, 3);
    EXPECT_EQ(all.frames.back().index, 6);
    EXPECT_EQ(all.faults.size(), 1U);
    EXPECT_EQ(source->frame_count(), 4);
    EXPECT_EQ(source->rewind(), knows);
    if (knows) {
      EXPECT_EQ(read_all(*source).frames.size(), 3U);
    }
  }
}

TEST(FrameRange, OfARecordedSessionIsByPositionWhateverItsFramesAreNumbered) {
  std::vector<Frame> frames(10);
  for (std::size_t i = 0; i < frames.size(); ++i) frames[i].index = 400 + 2 * static_cast<std::int64_t>(i);
  const auto source = limit_frames(std::make_unique<test::KeptSource>(std::move(frames)), 3, 6);
  for (int reading = 0; reading < 2; ++reading) {
    const auto all = read_all(*source);
    ASSERT_EQ(all.frames.size(), 4U);
    EXPECT_EQ(all.frames.front().index, 406);
    EXPECT_EQ(all.frames.back().index, 412);
    ASSERT_TRUE(source->rewind());
  }
}

TEST(FrameRange, WhoeverReadsCanStopBeforeItsFirstFrame) {
  const auto source = limit_frames(std::make_unique<MadeSource>(60, false), 40, 41);
  Frame frame;
  int waited = 0;
  ReadResult read = source->next(frame);
  for (; read.status == ReadStatus::kWaiting; read = source->next(frame)) ++waited;
  EXPECT_EQ(waited, 2);
  EXPECT_EQ(read.status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, 40);
}

TEST(FrameRange, EndsWithADeviceThatEndsEarly) {
  const auto source = limit_frames(std::make_unique<MadeSource>(10, false), 8, 30);
  const auto all = read_all(*source);
  ASSERT_EQ(all.frames.size(), 2U);
  EXPECT_EQ(all.frames.back().index, 9);
  EXPECT_TRUE(all.faults.empty());
}

TEST(FrameRange, OutsideTheRecordingNamesItsLength) {
  EXPECT_TRUE(
      contains(error_of([] { limit_frames(std::make_unique<MadeSource>(10, true), 5, 10); }), "10 frames"));
  const auto source = limit_frames(std::make_unique<MadeSource>(10, false), 10, 12);
  EXPECT_TRUE(contains(error_of([&] { (void)read_all(*source); }), "10 frames"));
  EXPECT_FALSE(error_of([] { limit_frames(std::make_unique<MadeSource>(10, true), 5, 4); }).empty());
  EXPECT_FALSE(error_of([] { limit_frames(std::make_unique<MadeSource>(10, true), -1, 4); }).empty());
}

void expect_same(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.stamp_s, b.stamp_s);
  EXPECT_EQ(a.colour_after_depth_s, b.colour_after_depth_s);
  EXPECT_EQ(a.depth_m.pixels, b.depth_m.pixels);
  EXPECT_EQ(a.colour.pixels, b.colour.pixels);
  EXPECT_EQ(a.colour.width, b.colour.width);
  EXPECT_EQ(a.depth_camera, b.depth_camera);
  EXPECT_EQ(a.colour_camera, b.colour_camera);
  EXPECT_EQ(a.T_colour_depth.matrix(), b.T_colour_depth.matrix());
  EXPECT_EQ(a.T_world_camera->matrix(), b.T_world_camera->matrix());
  EXPECT_EQ(*a.down_camera, *b.down_camera);
}

TEST(SpooledSource, GivesTheSameAgainToTheBit) {
  SpooledSource source(std::make_unique<MadeSource>(7, false, std::vector<int>{2}));
  EXPECT_FALSE(source.frame_count());
  const auto first = read_all(source);
  EXPECT_EQ(source.frame_count(), 7);
  ASSERT_TRUE(source.rewind());
  const auto again = read_all(source);
  ASSERT_EQ(first.frames.size(), 6U);
  ASSERT_EQ(again.frames.size(), first.frames.size());
  EXPECT_EQ(again.faults, first.faults);
  for (std::size_t i = 0; i < first.frames.size(); ++i) expect_same(first.frames[i], again.frames[i]);
}

TEST(SpooledSource, ReadsOnWhereItHadStopped) {
  SpooledSource source(std::make_unique<MadeSource>(7, false));
  Frame frame;
  for (int i = 0; i < 3; ++i) ASSERT_EQ(source.next(frame).status, ReadStatus::kFrame);
  source.rewind();
  const auto all = read_all(source);
  ASSERT_EQ(all.frames.size(), 7U);
  for (int i = 0; i < 7; ++i) EXPECT_EQ(all.frames[static_cast<std::size_t>(i)].index, i);
}

TEST(SpooledSource, LeavesNothingBehind) {
  const test::TemporaryFolder parent;
  {
    SpooledSource source(std::make_unique<MadeSource>(3, false), parent.path());
    (void)read_all(source);
    EXPECT_FALSE(std::filesystem::is_empty(parent.path()));
  }
  EXPECT_TRUE(std::filesystem::is_empty(parent.path()));
  EXPECT_TRUE(contains(
      error_of([&] { SpooledSource(std::make_unique<MadeSource>(1, false), parent.path() / "absent"); }),
      "absent"));
}

TEST(ScratchFolder, IsRemovedAtTheEndAlsoAfterAMove) {
  const test::TemporaryFolder parent;
  {
    ScratchFolder first(parent.path());
    write_bytes(first.path() / "frame", "bytes");
    const ScratchFolder second = std::move(first);
    EXPECT_TRUE(first.path().empty());
    EXPECT_TRUE(std::filesystem::exists(second.path() / "frame"));
  }
  EXPECT_TRUE(std::filesystem::is_empty(parent.path()));
}

TEST(ScratchFolder, RemovesThoseOfKilledProcessesOnly) {
  const test::TemporaryFolder parent;
  std::filesystem::create_directory(parent.path() / "roomradar-other");
  std::filesystem::create_directory_symlink(parent.path() / "roomradar-other",
                                            parent.path() / "roomradar-scratch-linked");
  const ScratchFolder running(parent.path());
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {  // as killed: no destructor runs
    const ScratchFolder left(parent.path());
    write_bytes(left.path() / "frame", "bytes");
    const std::string name = left.path().string();
    _exit(write(ends[1], name.data(), name.size()) > 0 ? 0 : 1);
  }
  close(ends[1]);
  std::string left(4096, '\0');
  const ssize_t length = read(ends[0], left.data(), left.size());
  close(ends[0]);
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_EQ(status, 0);
  ASSERT_GT(length, 0);
  left.resize(static_cast<std::size_t>(length));
  EXPECT_TRUE(std::filesystem::exists(left + "/frame"));

  const ScratchFolder next(parent.path());
  EXPECT_FALSE(std::filesystem::exists(left));
  EXPECT_TRUE(std::filesystem::exists(running.path()));
  EXPECT_TRUE(std::filesystem::exists(next.path()));
  EXPECT_TRUE(std::filesystem::exists(parent.path() / "roomradar-other"));
  EXPECT_TRUE(std::filesystem::is_symlink(parent.path() / "roomradar-scratch-linked"));
}

TEST(ScratchFolder, ProcessesThatBeginTogetherKeepTheirFolders) {
  const test::TemporaryFolder parent;
  std::array<pid_t, 4> children{};
  for (pid_t& child : children) {
    child = fork();
    if (child != 0) continue;
    for (int i = 0; i < 300; ++i) {
      const ScratchFolder own(parent.path());
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      if (!std::filesystem::exists(own.path())) _exit(1);
    }
    _exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
}

/// Delivers this many of a source's frames, then nothing for the time being.
class PausingSource final : public FrameSource {
 public:
  PausingSource(std::unique_ptr<FrameSource> source, int count) : source_(std::move(source)), left_(count) {}
  ReadResult next(Frame& frame) override {
    if (left_-- > 0) return source_->next(frame);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    return {ReadStatus::kWaiting, "nothing yet"};
  }
  bool rewind() override { return false; }
  [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return source_->frame_count(); }
  [[nodiscard]] std::string name() const override { return source_->name(); }

 private:
  std::unique_ptr<FrameSource> source_;
  int left_;
};

TEST(SpooledSource, ASourceThatWaitsIsNoFrameAndHoldsNobody) {
  SpooledSource source(std::make_unique<PausingSource>(std::make_unique<MadeSource>(9, false), 2));
  Frame frame;
  EXPECT_EQ(source.next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(source.next(frame).status, ReadStatus::kFrame);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(source.next(frame).status, ReadStatus::kWaiting);
  EXPECT_FALSE(source.seek(2));
  ASSERT_TRUE(source.seek(1));
  EXPECT_EQ(source.next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(frame.index, 1);
}

TEST(SpooledSource, LetsGoOfASourceThatHasEnded) {
  class LetGo final : public FrameSource {
   public:
    explicit LetGo(std::promise<void> gone) : gone_(std::move(gone)) {}
    LetGo(const LetGo&) = delete;
    LetGo& operator=(const LetGo&) = delete;
    ~LetGo() override { gone_.set_value(); }
    ReadResult next(Frame& frame) override { return source_.next(frame); }
    bool rewind() override { return false; }
    [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
    [[nodiscard]] std::string name() const override { return "device"; }

   private:
    MadeSource source_{5, false};
    std::promise<void> gone_;
  };
  std::promise<void> gone;
  std::future<void> is_gone = gone.get_future();
  SpooledSource source(std::make_unique<LetGo>(std::move(gone)));
  EXPECT_EQ(read_all(source).frames.size(), 5U);
  EXPECT_EQ(is_gone.wait_for(std::chrono::seconds(20)), std::future_status::ready);
  EXPECT_EQ(source.frame_count(), 5);
  EXPECT_EQ(source.name(), "device");
  ASSERT_TRUE(source.rewind());
  EXPECT_EQ(read_all(source).frames.size(), 5U);
}

TEST(SpooledSource, AReaderThatIsSlowLosesNothing) {
  // The source reaches its end before the second frame is requested.
  const auto made = std::make_shared<std::atomic<int>>(0);
  class Counting final : public FrameSource {
   public:
    explicit Counting(std::shared_ptr<std::atomic<int>> ends) : source_(20, false), ends_(std::move(ends)) {}
    ReadResult next(Frame& frame) override {
      ReadResult result = source_.next(frame);
      if (result.status == ReadStatus::kEnd) ++*ends_;
      return result;
    }
    bool rewind() override { return false; }
    [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
    [[nodiscard]] std::string name() const override { return "counting"; }

   private:
    MadeSource source_;
    std::shared_ptr<std::atomic<int>> ends_;
  };
  SpooledSource source(std::make_unique<Counting>(made));
  Frame frame;
  ASSERT_EQ(source.next(frame).status, ReadStatus::kFrame);
  while (*made == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(read_all(source).frames.size(), 19U);
}

TEST(SpooledSource, WhatTheSourceThrowsComesAfterItsLastFrame) {
  class Failing final : public FrameSource {
   public:
    ReadResult next(Frame& frame) override {
      if (given_++ == 3) throw Error("the device has gone");
      return source_.next(frame);
    }
    bool rewind() override { return false; }
    [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
    [[nodiscard]] std::string name() const override { return "failing"; }

   private:
    MadeSource source_{9, false};
    int given_ = 0;
  };
  SpooledSource source(std::make_unique<Failing>());
  Frame frame;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(source.next(frame).status, ReadStatus::kFrame);
  for (int i = 0; i < 2; ++i) EXPECT_EQ(error_of([&] { (void)source.next(frame); }), "the device has gone");
}

TEST(SpooledSource, KeptGoesOnInALaterProcess) {
  const test::TemporaryFolder parent;
  const std::filesystem::path folder = parent.path() / "spool";
  Frame frame;
  std::vector<Frame> first;
  {
    const auto source = SpooledSource::kept(
        std::make_unique<PausingSource>(std::make_unique<MadeSource>(9, false, std::vector<int>{1}), 4),
        folder);
    for (int i = 0; i < 4; ++i)
      if (source->next(frame).status == ReadStatus::kFrame) first.push_back(frame);
  }
  EXPECT_FALSE(SpooledSource::has_end(folder));
  // As if the process was killed while writing a fifth entry.
  std::filesystem::resize_file(folder / "list.bin", std::filesystem::file_size(folder / "list.bin") - 3);
  {
    const auto source = SpooledSource::kept(std::make_unique<MadeSource>(3, false), folder);
    const auto all = read_all(*source);
    ASSERT_EQ(all.faults.size(), 1U);
    ASSERT_EQ(all.frames.size(), 5U);  // two, and the device's three
    for (std::size_t i = 0; i < 2; ++i) expect_same(all.frames[i], first[i]);
    for (std::size_t i = 1; i < all.frames.size(); ++i) {
      EXPECT_EQ(all.frames[i].index, all.frames[i - 1].index + (i == 1 ? 2 : 1));
      EXPECT_GT(all.frames[i].stamp_s, all.frames[i - 1].stamp_s);
    }
  }
  ASSERT_TRUE(SpooledSource::has_end(folder));
  const auto source = SpooledSource::kept(nullptr, folder);
  EXPECT_EQ(read_all(*source).frames.size(), 5U);
  ASSERT_TRUE(source->rewind());
  EXPECT_EQ(read_all(*source).frames.size(), 5U);
}

/// The list of three frames that were spooled completely.
std::string list_of_three(const std::filesystem::path& folder) {
  (void)read_all(*SpooledSource::kept(std::make_unique<MadeSource>(3, false), folder));
  return read_bytes(folder / "list.bin", "a list");
}

TEST(SpooledSource, AnEntryThatIsDamagedIsOneFrameThatCannotBeRead) {
  const test::TemporaryFolder parent;
  const std::filesystem::path folder = parent.path() / "spool";
  std::string list = list_of_three(folder);
  const std::size_t head_bytes = 8 + 8 + MadeSource(3, false).name().size();
  const std::size_t entry_bytes = (list.size() - head_bytes - 4) / 3;     // the end mark has 4 bytes
  const std::size_t width_at = head_bytes + entry_bytes + 4 + 8 + 3 * 8;  // after size, fault, index, stamps
  list.replace(width_at, 4, "\xff\xff\xff\xff");  // width of the second frame's depth camera
  write_bytes(folder / "list.bin", list);
  const auto all = read_all(*SpooledSource::kept(nullptr, folder));
  ASSERT_EQ(all.faults.size(), 1U);
  EXPECT_TRUE(contains(all.faults[0], "list.bin")) << all.faults[0];
  ASSERT_EQ(all.frames.size(), 2U);
  EXPECT_EQ(all.frames[1].index, 2);
}

TEST(SpooledSource, ZerosThatAPowerFailureLeavesAreNoEnd) {
  const test::TemporaryFolder parent;
  const std::filesystem::path folder = parent.path() / "spool";
  const std::string list = list_of_three(folder);
  ASSERT_TRUE(SpooledSource::has_end(folder));
  write_bytes(folder / "list.bin", list.substr(0, list.size() - 4) + std::string(64, '\0'));
  EXPECT_FALSE(SpooledSource::has_end(folder));
  const auto source = SpooledSource::kept(std::make_unique<MadeSource>(2, false), folder);
  EXPECT_EQ(read_all(*source).frames.size(), 5U) << "the zeros are written over";
  EXPECT_TRUE(SpooledSource::has_end(folder));
  EXPECT_EQ(read_all(*SpooledSource::kept(nullptr, folder)).frames.size(), 5U);
}

TEST(SpooledSource, AListThatWasCutOffInItsHeadHoldsNoFrameAndIsBegunAnew) {
  const test::TemporaryFolder parent;
  for (const char* head : {"", "RRSPO"}) {
    const std::filesystem::path folder = parent.path() / ("spool" + std::string(head));
    std::filesystem::create_directories(folder);
    write_bytes(folder / "list.bin", head);
    EXPECT_FALSE(SpooledSource::has_end(folder));
    EXPECT_FALSE(SpooledSource::has_frames(folder));
    EXPECT_EQ(read_all(*SpooledSource::kept(std::make_unique<MadeSource>(2, false), folder)).frames.size(),
              2U);
    EXPECT_TRUE(SpooledSource::has_end(folder));
  }
}

TEST(SpooledSource, AnImageThatIsNotItsCamerasIsNamed) {
  const test::TemporaryFolder parent;
  const std::filesystem::path folder = parent.path() / "spool";
  (void)read_all(*SpooledSource::kept(std::make_unique<MadeSource>(3, false), folder));
  Frame frame;
  for (const DepthImage& depth_m :
       {DepthImage(3, 2, 1.0F), DepthImage(16, 12, -1.0F), DepthImage(16, 12, std::nanf("")),
        DepthImage(16, 12, std::numeric_limits<float>::infinity())}) {
    Frame damaged = test::some_frame(1);
    damaged.depth_m = depth_m;
    write_frame_images(damaged, folder / "1.images");
    const auto source = SpooledSource::kept(nullptr, folder);
    EXPECT_EQ(source->next(frame).status, ReadStatus::kFrame);
    const ReadResult damage = source->next(frame);
    EXPECT_EQ(damage.status, ReadStatus::kSkipped);
    EXPECT_TRUE(contains(damage.fault, "1.images: is damaged")) << damage.fault;
    EXPECT_EQ(source->next(frame).status, ReadStatus::kFrame) << "the next one is sound";
    EXPECT_EQ(frame.index, 2);
  }
}

/// Writes depth as earlier versions did: the floats' upper halves, and below them the lower halves.
void write_halves(const DepthImage& depth_m, const std::filesystem::path& path) {
  Image<std::uint16_t> halves(depth_m.width, 2 * depth_m.height);
  const std::size_t count = depth_m.pixels.size();
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(depth_m.pixels[i]);
    halves.pixels[i] = static_cast<std::uint16_t>(bits >> 16);
    halves.pixels[count + i] = static_cast<std::uint16_t>(bits);
  }
  const std::vector<std::uint8_t> png = encode_png(halves);
  write_bytes(path, std::string(png.begin(), png.end()));
}

TEST(SpooledSource, ReadsTheImagesOfEarlierVersions) {
  const test::TemporaryFolder parent;
  const std::filesystem::path folder = parent.path() / "spool";
  const auto first = read_all(*SpooledSource::kept(std::make_unique<MadeSource>(3, false), folder));
  for (const int i : {0, 1}) {
    std::filesystem::remove(folder / (std::to_string(i) + ".images"));
    write_halves(first.frames[static_cast<std::size_t>(i)].depth_m,
                 folder / (std::to_string(i) + ".depth.png"));
  }
  write_colour_file(first.frames[0].colour, folder / "0.colour.png");
  const auto again = read_all(*SpooledSource::again(folder));
  ASSERT_EQ(again.frames.size(), 3U);
  EXPECT_TRUE(again.frames[1].colour.empty());
  for (const std::size_t i : {0U, 2U}) expect_same(again.frames[i], first.frames[i]);
  EXPECT_EQ(again.frames[1].depth_m.pixels, first.frames[1].depth_m.pixels);
  std::filesystem::remove(folder / "2.images");
  EXPECT_TRUE(contains(read_all(*SpooledSource::again(folder)).faults.at(0), "2.images"));
}

TEST(SpooledSource, AFrameWithoutColourDoesNotTakeThatOfOneThatWasLost) {
  struct Colourless final : FrameSource {
    ReadResult next(Frame& frame) override {
      if (read == 2) return {ReadStatus::kEnd, {}};
      frame = test::some_frame(read++);
      frame.colour.resize(0, 0);
      return {ReadStatus::kFrame, {}};
    }
    bool rewind() override { return false; }
    [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
    [[nodiscard]] std::string name() const override { return "colourless"; }
    int read = 0;
  };
  const test::TemporaryFolder parent;
  const std::filesystem::path folder = parent.path() / "spool";
  std::filesystem::create_directories(folder);
  // Left by killed processes of an earlier version and of this one.
  write_colour_file(test::some_frame(7).colour, folder / "1.colour.png");
  write_frame_images(test::some_frame(7), folder / "1.images");
  (void)read_all(*SpooledSource::kept(std::make_unique<Colourless>(), folder));
  const auto all = read_all(*SpooledSource::again(folder));
  ASSERT_EQ(all.frames.size(), 2U);
  for (const Frame& frame : all.frames) EXPECT_TRUE(frame.colour.empty());
}

TEST(SpooledSource, IsNotReadAheadByMoreThanAsked) {
  struct Counted final : FrameSource {
    explicit Counted(std::atomic<int>& frames) : read(frames) {}
    ReadResult next(Frame& frame) override {
      frame = test::some_frame(read++);
      return {ReadStatus::kFrame, {}};
    }
    bool rewind() override { return false; }
    [[nodiscard]] std::optional<std::int64_t> frame_count() const override { return std::nullopt; }
    [[nodiscard]] std::string name() const override { return "counted"; }
    std::atomic<int>& read;
  };
  const test::TemporaryFolder parent;
  std::atomic<int> read = 0;
  const auto source = SpooledSource::kept(std::make_unique<Counted>(read), parent.path() / "spool", 2);
  Frame frame;
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
    EXPECT_EQ(frame.index, test::some_frame(i).index);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // an unlimited spool would read on
    EXPECT_LE(read, i + 3);
  }
  ASSERT_TRUE(source->rewind());
  for (int i = 0; i < 14; ++i) {
    ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
    EXPECT_EQ(frame.index, test::some_frame(i).index);
  }
}

TEST(SpooledSource, AListThatIsNoneIsRefused) {
  const test::TemporaryFolder parent;
  std::ofstream(parent.path() / "list.bin") << "something else";
  EXPECT_TRUE(
      contains(error_of([&] { SpooledSource::kept(std::make_unique<MadeSource>(1, false), parent.path()); }),
               "list.bin"));
}

TEST(SpooledSource, IsNotPutBeforeWhatRewindsByItself) {
  EXPECT_EQ(dynamic_cast<SpooledSource*>(make_rewindable(std::make_unique<MadeSource>(3, true)).get()),
            nullptr);
  EXPECT_NE(dynamic_cast<SpooledSource*>(make_rewindable(std::make_unique<MadeSource>(3, false)).get()),
            nullptr);
}

}  // namespace
}  // namespace roomradar::sources_units_test
