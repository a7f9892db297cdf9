// prescan_test.cpp: prescan with poses and images that no real camera produces.
#include "mapping/prescan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>

#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/types/system/file_io.hpp"
#include "mapping/types/system/process_memory.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/kept_source.hpp"
#include "tests/support/noisy_room.hpp"
#include "tests/support/painted_frame.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::prescan_test {
namespace {

constexpr int kFrames = 6;

std::vector<Frame> posed_frames() {
  std::vector<Frame> frames;
  for (int i = 0; i < kFrames; ++i) {
    const Eigen::Isometry3d eye = test::on_path(i, 2 * kFrames);
    frames.push_back(test::frame_at(eye, i));
    frames.back().T_world_camera = eye;
    frames.back().stamp_s = 0.2 * i;  // no camera goes so far in 1/30 s
  }
  return frames;
}

PrescanResult prescan_of(std::vector<Frame> frames, PoseOrigin poses = PoseOrigin::kRecorded,
                         double resolution_m = 0.03) {
  test::KeptSource source(std::move(frames));
  PrescanConfig config;
  config.poses = poses;
  config.resolution_m = resolution_m;
  StageTimes times;
  return prescan(source, config, times);
}

TEST(Prescan, ARecordedPoseThatNoMapReachesIsNone) {
  for (const double away_m : {1e4, 1e9, 1e15, 1e300, static_cast<double>(INFINITY), std::nan("")}) {
    std::vector<Frame> frames = posed_frames();
    frames[2].T_world_camera->translation().y() = away_m;
    const PrescanResult result = prescan_of(std::move(frames));
    EXPECT_EQ(result.counts.frames_tracked, kFrames - 1) << away_m;
    EXPECT_EQ(result.counts.frames_lost, 1) << away_m;
    EXPECT_EQ(result.counts.frames_fused, kFrames - 1) << away_m;
    EXPECT_TRUE(knows_recorded_world(result.map.info));
    ASSERT_FALSE(result.map.keyframe_database.load().keyframes.empty());
    for (const MapKeyframe& place : result.map.keyframe_database.load().keyframes)
      EXPECT_LT(place.T_world_camera.translation().norm(), 3.0) << away_m;
    for (const TimedPose& pose : result.map.trajectory)
      EXPECT_LT(pose.T_world_camera.translation().norm(), 3.0) << away_m;
  }
}

TEST(Prescan, OfALongScanAsManyFramesAreFusedAsTheConfigAllows) {
  for (const std::int64_t max_frames : {0, 3, kFrames}) {
    test::KeptSource source(posed_frames());
    PrescanConfig config;
    config.poses = PoseOrigin::kRecorded;
    config.resolution_m = 0.03;
    config.max_fused_frames = max_frames;
    StageTimes times;
    const PrescanResult result = prescan(source, config, times);
    EXPECT_EQ(result.counts.frames_tracked, kFrames);
    if (max_frames == 3)
      EXPECT_LE(result.counts.frames_fused, 3);
    else
      EXPECT_EQ(result.counts.frames_fused, kFrames);
    EXPECT_GT(result.counts.frames_fused, 0);
  }
}

TEST(Prescan, PosesThatAreAllOutOfReachAreNamed) {
  std::vector<Frame> frames = posed_frames();
  for (Frame& frame : frames) frame.T_world_camera->translation().x() += 1e5;
  EXPECT_NE(test::error_of([&] { prescan_of(frames); }).find("none within the octree's reach of"),
            std::string::npos);
  for (Frame& frame : frames) frame.T_world_camera.reset();
  EXPECT_NE(test::error_of([&] { prescan_of(frames); }).find("has no poses"), std::string::npos);
}

TEST(Prescan, TrackedFramesAreComparedWithPosesOfAnyOrigin) {
  std::vector<Frame> frames = posed_frames();
  const PrescanResult near = prescan_of(frames, PoseOrigin::kTracked);
  const Eigen::Vector3d survey_m(5e5, 4e6, 100.0);
  for (Frame& frame : frames) frame.T_world_camera->pretranslate(survey_m);
  const PrescanResult far = prescan_of(frames, PoseOrigin::kTracked);
  ASSERT_TRUE(near.counts.trajectory_error && far.counts.trajectory_error);
  EXPECT_TRUE(knows_recorded_world(near.map.info));
  EXPECT_EQ(far.counts.trajectory_error->poses, static_cast<std::size_t>(kFrames));
  EXPECT_NEAR(far.counts.trajectory_error->max_m, near.counts.trajectory_error->max_m, 1e-6);
  EXPECT_TRUE((far.map.info.T_world_recorded * Eigen::Translation3d(survey_m))
                  .isApprox(near.map.info.T_world_recorded, 1e-6));
}

TEST(Prescan, OneBadPoseIsNotWhatTrackingIsComparedWith) {
  std::vector<Frame> frames = posed_frames();
  frames[3].T_world_camera->translation().z() = 1e12;
  const PrescanResult with_it = prescan_of(frames, PoseOrigin::kTracked);
  frames[3].T_world_camera.reset();
  const PrescanResult without_it = prescan_of(frames, PoseOrigin::kTracked);
  ASSERT_TRUE(with_it.counts.trajectory_error && without_it.counts.trajectory_error);
  EXPECT_EQ(with_it.counts.trajectory_error->poses, static_cast<std::size_t>(kFrames - 1));
  EXPECT_EQ(with_it.counts.trajectory_error->max_m, without_it.counts.trajectory_error->max_m);
}

TEST(Prescan, AMapOfImagesOfAFewRowsIsReadAgain) {
  for (const int rows : {1, 3}) {
    std::vector<Frame> frames = posed_frames();
    for (Frame& frame : frames) {
      DepthImage few(frame.depth_m.width, rows);
      for (int y = 0; y < few.height; ++y)
        for (int x = 0; x < few.width; ++x) few.at(x, y) = frame.depth_m.at(x, 118 + y);
      frame.depth_m = few;
      frame.depth_camera.height_px = rows;
      frame.depth_camera.cy_px -= 118.0;
      frame.colour.resize(0, 0);
    }
    const SavedMap map = prescan_of(std::move(frames), PoseOrigin::kRecorded, 0.01).map;
    ASSERT_FALSE(map.keyframe_database.load().keyframes.empty());
    EXPECT_GT(map.keyframe_database.load().keyframes.front().preview_depth_mm.height, 0);
    const test::TemporaryFolder folder;
    save_map(folder.path() / "slit", map);
    EXPECT_TRUE(verify_map(folder.path() / "slit").empty());
    EXPECT_EQ(load_map(folder.path() / "slit").keyframe_database.load().keyframes.size(),
              map.keyframe_database.load().keyframes.size());
  }
}

TEST(Prescan, ALongScanThatOnlyBeginsInTheMapIsAddedToIt) {
  const auto along_a_wall = [](int frames) {
    const test::Scene corridor = test::nearest_of(test::plane({0, 1, 0}, 0.9), test::plane({0, 0, 1}, 0.0));
    std::vector<Frame> path;
    for (int i = 0; i < frames; ++i) {
      const double x_m = i < 10 ? 0.005 * i * i : 0.1 * i - 0.5;
      const Eigen::Isometry3d eye = test::looking_at({x_m, 0.0, 0.7}, {x_m, 0.9, 0.4});
      path.push_back(test::exact_frame(corridor, {160, 120, 146.0, 146.0, 79.5, 59.5}, eye));
      path.back().T_world_camera.reset();
      path.back().index = i;
      path.back().stamp_s = i / 30.0;
      test::paint(path.back(), eye);
    }
    return path;
  };
  PrescanConfig config;
  config.resolution_m = 0.02;
  StageTimes times;
  test::KeptSource at_the_door(along_a_wall(4)), into_the_next_rooms(along_a_wall(150));
  PrescanInput start{.map = prescan(at_the_door, config, times).map};
  const PrescanResult longer = prescan(into_the_next_rooms, config, times, {}, std::move(start));
  EXPECT_EQ(longer.counts.frames_fused, 150);
  EXPECT_FALSE(knows_recorded_world(longer.map.info));
  EXPECT_EQ(longer.map.trajectory.size(), 154U);
  EXPECT_NEAR((longer.map.trajectory.back().T_world_camera.translation() -
               longer.map.trajectory.front().T_world_camera.translation())
                  .norm(),
              14.4, 0.3);
}

/// Prescan that also bakes a texture.
PrescanResult textured_prescan(std::vector<Frame> frames, std::size_t max_memory_bytes = 0,
                               MapWriter* writer = nullptr) {
  test::KeptSource source(std::move(frames));
  PrescanConfig config;
  config.poses = PoseOrigin::kRecorded;
  config.resolution_m = 0.03;
  config.bake_texture = true;
  config.max_memory_bytes = max_memory_bytes;
  StageTimes times;
  PrescanInput input;
  input.writer = writer;
  return prescan(source, config, times, {}, std::move(input));
}

TEST(Prescan, TheTextureFitsTheMeshThatIsSaved) {
  const PrescanResult result = textured_prescan(posed_frames());
  ASSERT_NE(result.map.texture.load(), nullptr);
  const test::TemporaryFolder folder;
  save_map(folder.path() / "map", result.map);
  const auto [mesh, texture] = load_textured_map_mesh(folder.path() / "map");
  EXPECT_TRUE(fits(texture, mesh));
  EXPECT_EQ(verify_map(folder.path() / "map"), std::vector<std::string>{});
  EXPECT_EQ(prescan_of(posed_frames()).map.texture.load(), nullptr);  // only where it is asked for
}

std::string content(const std::filesystem::path& file) { return read_bytes(file, "a map's file", 1U << 26U); }

TEST(Prescan, AnOctreeThatIsSavedBeforeTheTextureIsThatOfTheMap) {
  const test::TemporaryFolder folder;
  const std::filesystem::path in_two_steps = folder.path() / "two", at_once = folder.path() / "one";
  MapWriter writer(in_two_steps);
  const PrescanResult result = textured_prescan(posed_frames(), 0, &writer);
  EXPECT_FALSE(std::filesystem::exists(in_two_steps)) << "only commit() makes it a map";
  writer.commit(result.map);
  save_map(at_once, textured_prescan(posed_frames()).map);
  EXPECT_EQ(verify_map(in_two_steps), std::vector<std::string>{});
  std::size_t files = 0;
  for (const auto& file : std::filesystem::directory_iterator(at_once)) {
    const std::filesystem::path name = file.path().filename();
    EXPECT_EQ(content(in_two_steps / name), content(at_once / name)) << name;
    ++files;
  }
  EXPECT_GE(files, 8U);
  EXPECT_EQ(result.map.octree.load().counts().nodes, load_map_octree(at_once).counts().nodes);
  EXPECT_EQ(result.map.info.counts.nodes, load_map_octree(at_once).counts().nodes);
}

TEST(Prescan, AMapThatIsNotCommittedLeavesTheOldOneAndNothingBeside) {
  const test::TemporaryFolder folder;
  save_map(folder.path() / "map", prescan_of(posed_frames()).map);
  const std::string before = content(folder.path() / "map" / kMapInfoFile);
  {
    MapWriter writer(folder.path() / "map");
    (void)textured_prescan(posed_frames(), 0, &writer);
  }
  EXPECT_EQ(content(folder.path() / "map" / kMapInfoFile), before);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Prescan, WithoutColourThereIsNoTexture) {
  std::vector<Frame> frames = posed_frames();
  for (Frame& frame : frames) frame.colour = {};
  const PrescanResult result = textured_prescan(std::move(frames));
  EXPECT_EQ(result.map.texture.load(), nullptr);
  EXPECT_FALSE(result.map.mesh.triangles.empty());
}

TEST(Prescan, AMemoryCapLeavesOutTheTextureNotTheMap) {
  const std::size_t cap = resident_bytes() + 100'000'000;
  const PrescanResult result = textured_prescan(posed_frames(), cap);
  EXPECT_EQ(result.map.texture.load(), nullptr);
  EXPECT_FALSE(result.counts.stopped_for_memory);
}

}  // namespace
}  // namespace roomradar::prescan_test
