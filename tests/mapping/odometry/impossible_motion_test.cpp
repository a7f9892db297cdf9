// impossible_motion_test.cpp: which poses a jump of the path takes the trust from.
#include "mapping/odometry/impossible_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace roomradar {
namespace {

/// A camera that moves at 0.5 m/s along x, with trusted poses.
std::vector<TrackedFrame> straight_path(int count, double rate_hz) {
  std::vector<TrackedFrame> frames;
  for (int i = 0; i < count; ++i) {
    TrackedFrame frame;
    frame.frame_index = i;
    frame.stamp_s = i / rate_hz;
    frame.T_world_camera.translation().x() = 0.5 * frame.stamp_s;
    frame.trusted = true;
    frames.push_back(frame);
  }
  return frames;
}

std::vector<int> distrusted(const std::vector<TrackedFrame>& frames) {
  std::vector<int> found;
  for (const TrackedFrame& frame : frames)
    if (!frame.trusted) found.push_back(static_cast<int>(frame.frame_index));
  return found;
}

TEST(ImpossibleMotion, StraightPathAndShakingHandStayTrusted) {
  std::vector<TrackedFrame> frames = straight_path(60, 30.0);
  EXPECT_EQ(distrust_impossible_motion(frames), 0);
  for (TrackedFrame& frame : frames)  // 5 Hz with 15 mm: 15 m/s^2
    frame.T_world_camera.translation().y() = 0.015 * std::sin(2.0 * M_PI * 5.0 * frame.stamp_s);
  EXPECT_EQ(distrust_impossible_motion(frames), 0);
}

TEST(ImpossibleMotion, AnExcursionLosesItsPosesAndOnlyThese) {
  std::vector<TrackedFrame> frames = straight_path(40, 30.0);
  for (int i = 20; i < 24; ++i) frames[static_cast<std::size_t>(i)].T_world_camera.translation().y() = 0.1;
  EXPECT_EQ(distrust_impossible_motion(frames), 6);  // the last before and the first after, too
  EXPECT_EQ(distrusted(frames), (std::vector<int>{19, 20, 21, 22, 23, 24}));
}

TEST(ImpossibleMotion, SmallNoiseOfAFastSensorIsNoMotion) {
  std::vector<TrackedFrame> frames = straight_path(40, 60.0);
  frames[20].T_world_camera.translation().y() = 0.012;  // 86 m/s^2 by the stamps
  EXPECT_EQ(distrust_impossible_motion(frames), 0);
}

TEST(ImpossibleMotion, SlowFramesMayStepFar) {
  std::vector<TrackedFrame> frames = straight_path(40, 1.5);
  frames[20].T_world_camera.translation().y() = 0.5;
  EXPECT_EQ(distrust_impossible_motion(frames), 0);
}

TEST(ImpossibleMotion, PartsAndFramesWithoutTrustAreNotCompared) {
  std::vector<TrackedFrame> frames = straight_path(40, 30.0);
  for (std::size_t i = 20; i < 40; ++i) {  // another part, somewhere else
    frames[i].part = 1;
    frames[i].T_world_camera.translation().y() = 3.0;
  }
  frames[10].trusted = false;
  frames[10].T_world_camera.translation().z() = 5.0;
  EXPECT_EQ(distrust_impossible_motion(frames), 0);
}

TEST(ImpossibleMotion, EmptyPathsAndEqualStamps) {
  std::vector<TrackedFrame> none;
  EXPECT_EQ(distrust_impossible_motion(none), 0);
  std::vector<TrackedFrame> frames = straight_path(10, 30.0);
  for (TrackedFrame& frame : frames) frame.stamp_s = 0.0;
  EXPECT_EQ(distrust_impossible_motion(frames), 0);
}

}  // namespace
}  // namespace roomradar
