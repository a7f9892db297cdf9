// scan_view_test.cpp: a scan that is watched, paused, finished and discarded.
#include "app/scan/scan_view.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

#include "app/scan/controlled_source.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"
#include "mapping/prescan.hpp"
#include "tests/support/kept_source.hpp"

namespace roomradar::scan_view_test {
namespace {

std::unique_ptr<FrameSource> room(int frames) {
  SimOptions options = parse_sim_spec("sim:table?seed=3&width=160&rate=10");
  options.frames = frames;
  return std::make_unique<SimulatedSource>(options);
}

PrescanConfig coarse() {
  PrescanConfig config;
  config.resolution_m = 0.04;
  return config;
}

TEST(ScanView, ShowsAScanAndDoesNotChangeIt) {
  StageTimes times;
  const auto plain = room(40);
  const PrescanResult unwatched = prescan(*plain, coarse(), times);

  std::atomic<int> woken = 0;
  ScanChannel channel([&] { ++woken; });
  const auto source = controlled(room(40), channel);
  PrescanResult watched;
  {
    ScanView view(channel);
    watched = prescan(*source, coarse(), times, {}, {nullptr, std::nullopt, &view});
  }
  EXPECT_EQ(watched.map.mesh.vertices, unwatched.map.mesh.vertices);
  EXPECT_EQ(watched.counts.frames_tracked, unwatched.counts.frames_tracked);

  ShownScan shown;
  ASSERT_TRUE(channel.take(shown));
  EXPECT_FALSE(channel.take(shown));  // only once
  EXPECT_GE(woken, 1);
  ASSERT_TRUE(channel.outcome().text.empty());
}

TEST(ScanView, ShowsPictureTintModelPathAndCounts) {
  ScanChannel channel;
  const auto source = room(30);
  Odometry odometry;
  StageTimes times;
  Frame frame;
  ShownScan shown;
  {
    ScanView view(channel);
    while (source->next(frame).status == ReadStatus::kFrame) {
      const Tracking tracking = times.timed("track", [&] { return odometry.track(frame); });
      view.after_frame(frame, tracking, odometry, times);
      // Slower than the view, so that it shows every frame, and longer than it waits between two meshes.
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
    }
  }
  ASSERT_TRUE(channel.take(shown));
  EXPECT_GE(shown.frame_index, 20);
  EXPECT_EQ(shown.status, TrackStatus::kTracked);
  EXPECT_EQ(shown.fault, std::nullopt);
  EXPECT_EQ(shown.picture.width, 160);
  EXPECT_EQ(shown.tint.width, 20);
  EXPECT_GE(shown.path_world.size(), 2U);
  ASSERT_FALSE(shown.parts.empty());
  EXPECT_GT(shown.parts.front().mesh->triangles.size(), 100U);
  EXPECT_GT(shown.counts.seen_m2, 1.0);
  EXPECT_GT(shown.counts.frames, 20);
  EXPECT_GT(shown.counts.track_ms, 0.1);
  EXPECT_GT(shown.relative_speed, 0.0);
  // The world's +z is up: the camera's image rows go down.
  EXPECT_LT(shown.T_world_camera.linear().col(1).z(), -0.5);
}

/// Undoes two seconds after frame 30.
class UndoOnce final : public ScanObserver {
 public:
  void after_frame(const Frame& frame, const Tracking& /*tracking*/, const Odometry& odometry,
                   const StageTimes& /*times*/) override {
    last_index = frame.index;
    for (const Keyframe& keyframe : odometry.state().graph.keyframes)
      EXPECT_TRUE(forgotten_from < 0 || keyframe.frame_index < forgotten_from || keyframe.frame_index > 30);
  }
  double take_undo_s() override { return last_index == 30 && forgotten_from < 0 ? 2.0 : 0.0; }
  void forgot_frames(std::int64_t from_index) override { forgotten_from = from_index; }

  std::int64_t last_index = -1, forgotten_from = -1;
};

/// Frames 0 to 30 of a scan, then the camera is back where it was at frame 8, and goes on from there.
test::KeptSource going_back() {
  const auto source = room(60);
  std::vector<Frame> all, frames;
  for (Frame frame; source->next(frame).status == ReadStatus::kFrame;) all.push_back(frame);
  for (std::size_t i = 0; i < 70; ++i) {
    frames.push_back(all[i <= 30 ? i : i - 23]);
    frames.back().index = static_cast<std::int64_t>(i);
    frames.back().stamp_s = 0.1 * static_cast<double>(i);
  }
  return test::KeptSource(std::move(frames));
}

TEST(ScanObserver, UndoneFramesHaveNoPoseAndTheScanGoesOn) {
  StageTimes times;
  test::KeptSource source = going_back();
  UndoOnce observer;
  const PrescanResult scanned = prescan(source, coarse(), times, {}, {nullptr, std::nullopt, &observer});
  EXPECT_EQ(observer.forgotten_from, 10);  // ten frames a second
  std::set<std::int64_t> posed;
  for (const TimedPose& pose : scanned.map.trajectory) posed.insert(pose.frame_index);
  for (std::int64_t i = 0; i < 10; ++i) EXPECT_TRUE(posed.contains(i)) << i;
  for (std::int64_t i = 10; i <= 30; ++i) EXPECT_FALSE(posed.contains(i)) << i;
  for (std::int64_t i = 31; i < 70; ++i) EXPECT_TRUE(posed.contains(i)) << i;
  EXPECT_EQ(scanned.counts.frames_read, 70);
  EXPECT_EQ(scanned.counts.frames_fused, scanned.counts.frames_tracked);
}

TEST(ScanObserver, UndoingEverythingBeginsAgain) {
  OdometrySnapshot kept;
  kept.frames.resize(2);
  kept.frames[0].frame_index = 4;
  kept.frames[1].frame_index = 5;
  kept.graph.keyframes.resize(1);
  kept.graph.keyframes[0].frame_index = 4;
  kept.keyframe_database.keyframes.resize(1);
  kept.keyframe_database.keyframes[0].frame_index = 4;
  forget_frames_from(5, kept);
  EXPECT_EQ(kept.frames.size(), 1U);
  EXPECT_EQ(kept.graph.keyframes.size(), 1U);
  forget_frames_from(0, kept);
  EXPECT_TRUE(kept.frames.empty());
  EXPECT_TRUE(kept.graph.keyframes.empty());
  EXPECT_TRUE(kept.keyframe_database.keyframes.empty());
}

TEST(ControlledSource, EndsAtARequestToFinishAndDeliversTheRestOnceRewound) {
  ScanChannel channel;
  const auto source = controlled(room(6), channel);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  channel.request(ScanRequest::kFinish);
  EXPECT_EQ(source->next(frame).status, ReadStatus::kEnd);
  ASSERT_TRUE(source->rewind());
  for (int i = 0; i < 6; ++i) EXPECT_EQ(source->next(frame).status, ReadStatus::kFrame);
  EXPECT_EQ(source->next(frame).status, ReadStatus::kEnd);
}

TEST(ControlledSource, RewoundBeforeItsEndItStillHeedsTheChannel) {
  ScanChannel channel;
  const auto source = controlled(room(6), channel);
  Frame frame;
  ASSERT_EQ(source->next(frame).status, ReadStatus::kFrame);
  ASSERT_TRUE(source->rewind());  // as when tracking begins again
  channel.request(ScanRequest::kFinish);
  EXPECT_EQ(source->next(frame).status, ReadStatus::kEnd);
}

TEST(ControlledSource, ThrowsIfTheScanIsDiscarded) {
  ScanChannel channel;
  const auto source = controlled(room(6), channel);
  Frame frame;
  channel.request(ScanRequest::kDiscard);
  EXPECT_THROW(static_cast<void>(source->next(frame)), ScanDiscarded);
}

TEST(ControlledSource, WaitsWhilePaused) {
  ScanChannel channel;
  const auto source = controlled(room(6), channel);
  channel.set_paused(true);
  std::atomic<bool> is_read = false;
  std::thread reader([&] {
    Frame frame;
    static_cast<void>(source->next(frame));
    is_read = true;
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_FALSE(is_read);
  channel.set_paused(false);
  reader.join();
  EXPECT_TRUE(is_read);
}

TEST(ControlledSource, ARequestEndsAPause) {
  ScanChannel channel;
  const auto source = controlled(room(6), channel);
  channel.set_paused(true);
  channel.request(ScanRequest::kFinish);
  Frame frame;
  EXPECT_EQ(source->next(frame).status, ReadStatus::kEnd);
}

}  // namespace
}  // namespace roomradar::scan_view_test
