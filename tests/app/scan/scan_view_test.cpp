// scan_view_test.cpp: a scan that is watched, paused, finished and discarded.
#include "app/scan/scan_view.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "app/scan/controlled_source.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/prescan.hpp"

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
  ASSERT_TRUE(channel.outcome().empty());
}

TEST(ScanView, ShowsPictureTintModelPathAndCounts) {
  ScanChannel channel;
  const auto source = room(30);
  Odometry odometry;
  Frame frame;
  ShownScan shown;
  {
    ScanView view(channel);
    while (source->next(frame).status == ReadStatus::kFrame) {
      const Tracking tracking = odometry.track(frame);
      view.after_frame(frame, tracking, odometry);
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
  EXPECT_GT(shown.relative_speed, 0.0);
  // The world's +z is up: the camera's image rows go down.
  EXPECT_LT(shown.T_world_camera.linear().col(1).z(), -0.5);
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
