// fusion_selection_test.cpp: all frames of short scans are fused, and of long ones those with another view.
#include "mapping/fusion_selection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace roomradar::fusion_selection_test {
namespace {

/// Poses along x, `step_m` apart.
std::vector<TimedPose> walk(std::size_t count, double step_m, double step_rad = 0.0) {
  std::vector<TimedPose> poses(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto n = static_cast<double>(i);
    poses[i].frame_index = static_cast<std::int64_t>(i);
    poses[i].T_world_camera = Eigen::Translation3d(n * step_m, 0.0, 0.0) *
                              Eigen::AngleAxisd(n * step_rad, Eigen::Vector3d::UnitZ());
  }
  return poses;
}

std::size_t greatest_gap(const std::vector<std::size_t>& chosen) {
  std::size_t gap = 0;
  for (std::size_t i = 1; i < chosen.size(); ++i) gap = std::max(gap, chosen[i] - chosen[i - 1]);
  return gap;
}

TEST(FusionSelection, AllFramesOfAShortScanAreChosen) {
  const auto poses = walk(100, 0.001);
  for (const std::size_t max_frames : {std::size_t{100}, std::size_t{2000}, std::size_t{0}})
    EXPECT_EQ(choose_frames_to_fuse(poses, max_frames).size(), 100U) << max_frames;
  EXPECT_TRUE(choose_frames_to_fuse({}, 10).empty());
}

TEST(FusionSelection, AStillCameraGivesFramesAtEqualIntervals) {
  const auto chosen = choose_frames_to_fuse(walk(1000, 0.0), 200);
  EXPECT_EQ(chosen.front(), 0U);
  EXPECT_GE(chosen.size(), 150U);
  EXPECT_LE(chosen.size(), 200U);
  EXPECT_LE(greatest_gap(chosen), 7U);
}

TEST(FusionSelection, WhereTheCameraMovesOrTurnsMoreFramesAreChosen) {
  for (const bool turns : {false, true}) {
    std::vector<TimedPose> poses = walk(500, 0.0);
    for (const TimedPose& pose : walk(500, turns ? 0.0 : 0.02, turns ? 0.02 : 0.0)) poses.push_back(pose);
    const auto chosen = choose_frames_to_fuse(poses, 500);
    const auto moving = static_cast<std::size_t>(
        std::count_if(chosen.begin(), chosen.end(), [](std::size_t i) { return i >= 500; }));
    EXPECT_LE(chosen.size(), 500U);
    EXPECT_GT(moving, 2 * (chosen.size() - moving)) << turns;
    EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  }
}

TEST(FusionSelection, OneFrameIsLeftHoweverFarTheCameraMoves) {
  EXPECT_EQ(choose_frames_to_fuse(walk(300, 2.0, 1.0), 1), std::vector<std::size_t>{0});
}

}  // namespace
}  // namespace roomradar::fusion_selection_test
