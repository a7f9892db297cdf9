// prescan_state_test.cpp: a prescan's state on disk is restored unchanged, and damaged files are rejected.
#include "mapping/prescan_state.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <random>
#include <string>

#include "mapping/types/system/error.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::prescan_state_test {
namespace {

namespace fs = std::filesystem;

constexpr Intrinsics kCamera{80, 60, 73.0, 73.0, 40.0, 30.0};

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Frame seen_from(const Eigen::Isometry3d& T_world_camera) {
  const test::Scene room = test::nearest_of(test::plane(Eigen::Vector3d::UnitZ(), 0.0),
                                            test::plane(Eigen::Vector3d::UnitY(), 2.0));
  Frame frame = test::exact_frame(room, kCamera, T_world_camera);
  test::paint(frame, T_world_camera);
  return frame;
}

Eigen::Isometry3d pose(int i) { return test::looking_at({0.05 * i, -0.3, 1.2}, {0.05 * i + 0.2, 1.8, 0.3}); }

/// A half-finished second pass.
FusionPass fusing_pass(int frames) {
  FusionPass pass;
  pass.octree = StaticMap(0.05);
  pass.counts.frames_read = 12;
  pass.counts.last_fault = "frame 3 is broken";
  pass.found.up = {UpSource::kPlane, Eigen::Vector3d::UnitZ(), 0.4};
  pass.T_world_found.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  pass.ghost_voxels = 5;
  pass.stopped_for_memory = true;
  pass.revision = GhostRevision{{{{1, -2, 3}}, {{4, 5, 6}, {7, 8, 9}}, {}, {{-7, 8, -9}}}, 2};
  for (int i = 0; i < frames; ++i) {
    const Frame frame = seen_from(pose(i));
    EXPECT_EQ(pass.octree.fuse(frame, pose(i)), FuseStatus::kFused);
    pass.fused.push_back({i, i, kCamera, pose(i)});
    pass.found.frames.push_back({i, i / 30.0, pose(i), TrackStatus::kDegenerate, true});
    pass.found.recorded.push_back({i, i / 30.0, pose(i)});
    pass.frames_read = i + 1;
    if (i % 4 == 0) pass.found.keyframe_database.keyframes.push_back(make_map_keyframe(frame, pose(i)));
  }
  return pass;
}

TEST(PrescanState, TheSecondPassGoesOnAsIfItHadNeverEnded) {
  const test::TemporaryFolder folder;
  FusionPass whole = fusing_pass(6);
  write_state(whole, folder.path(), {});
  FusionPass resumed = read_fusing_pass({kFusingStage, folder.path()});
  EXPECT_EQ(resumed.counts.frames_read, 12);
  EXPECT_EQ(resumed.counts.last_fault, "frame 3 is broken");
  EXPECT_EQ(resumed.frames_read, 6);
  EXPECT_EQ(resumed.ghost_voxels, 5);
  EXPECT_TRUE(resumed.stopped_for_memory);
  ASSERT_TRUE(resumed.revision);
  EXPECT_EQ(resumed.revision->verdicts.ghosts, whole.revision->verdicts.ghosts);
  EXPECT_EQ(resumed.revision->verdicts.absent, whole.revision->verdicts.absent);
  EXPECT_EQ(resumed.revision->next, 2U);
  EXPECT_EQ(resumed.T_world_found.matrix(), whole.T_world_found.matrix());
  ASSERT_EQ(resumed.found.frames.size(), 6U);
  EXPECT_EQ(resumed.found.frames[5].status, TrackStatus::kDegenerate);
  EXPECT_EQ(resumed.fused[3].T_world_camera.matrix(), whole.fused[3].T_world_camera.matrix());
  for (int i = 6; i < 12; ++i) {
    const Frame frame = seen_from(pose(i));
    whole.octree.fuse(frame, pose(i));
    resumed.octree.fuse(frame, pose(i));
  }
  whole.octree.write_ot(folder.path() / "whole.ot");
  resumed.octree.write_ot(folder.path() / "resumed.ot");
  EXPECT_TRUE(text_of(folder.path() / "whole.ot") == text_of(folder.path() / "resumed.ot"));
}

TEST(PrescanState, TheFirstPassKeepsWhatItKnowsOfUp) {
  const test::TemporaryFolder folder;
  TrackingPass pass{OdometryConfig{}};
  for (int i = 0; i < 3; ++i) {
    Frame frame = seen_from(pose(i));
    frame.index = i;
    const Tracking tracking = pass.odometry.track(frame);
    pass.up.front().add(frame, pose(i));
    pass.recorded.push_back({i, i / 30.0, tracking.T_world_camera});
    ++pass.counts.frames_read;
  }
  pass.odometry.finish_jobs();
  write_state(pass, folder.path(), {});
  const TrackingPass resumed = read_tracking_pass({kTrackingStage, folder.path()}, {});
  EXPECT_EQ(resumed.counts.frames_read, 3);
  EXPECT_EQ(resumed.odometry.counts().frames, 3);
  EXPECT_EQ(resumed.up.front().estimate().up_world, pass.up.front().estimate().up_world);
  ASSERT_EQ(resumed.recorded.size(), 3U);
}

TEST(PrescanState, BrokenBytesAreRefusedOrHarmless) {
  const test::TemporaryFolder folder;
  FusionPass pass = fusing_pass(4);
  write_state(pass, folder.path(), {});
  const fs::path path = folder.path() / "state.bin";
  const std::string good = text_of(path);
  std::mt19937 random(3);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    std::string bytes = good;
    if (i % 4 == 0)
      bytes.resize(random() % bytes.size());
    else
      for (unsigned n = 0; n <= random() % 3; ++n)
        bytes[random() % bytes.size()] = static_cast<char>(random());
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      static_cast<void>(read_fusing_pass({kFusingStage, folder.path()}));
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("state.bin"), std::string::npos) << error.what();
      ++refused;
    }
  }
  EXPECT_GE(refused, 100);  // all truncated files
}

}  // namespace
}  // namespace roomradar::prescan_state_test
