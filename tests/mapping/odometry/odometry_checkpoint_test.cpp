// odometry_checkpoint_test.cpp: odometry that is saved and resumed, and odometry with a prior map.
#include "mapping/odometry/odometry_checkpoint.hpp"
#include "mapping/odometry/odometry_snapshot.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "tests/support/error_of.hpp"
#include "tests/support/noisy_room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::odometry_checkpoint_test {
namespace {

namespace fs = std::filesystem;
using test::frame_at, test::on_path;

constexpr int kFrames = 60;

void track(Odometry& odometry, int begin, int end) {
  for (int i = begin; i < end; ++i) EXPECT_TRUE(odometry.track(frame_at(on_path(i, kFrames), i))) << i;
}

fs::path folder_in(const test::TemporaryFolder& folder, const char* name) {
  fs::create_directory(folder.path() / name);
  return folder.path() / name;
}

std::string read_bytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write_bytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

TEST(OdometryCheckpoint, GoesOnAsIfItHadNeverEnded) {
  const test::TemporaryFolder folder;
  const fs::path checkpoint = folder_in(folder, "a");
  Odometry whole;
  track(whole, 0, 16);
  whole.finish_jobs();
  save_odometry(whole, checkpoint, {});
  Odometry resumed = load_odometry(checkpoint, {});
  EXPECT_EQ(resumed.counts().frames, 16);
  track(whole, 16, 26);
  track(resumed, 16, 26);
  const std::vector<TrackedFrame> expected = whole.optimise(), found = resumed.optimise();
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].frame_index, expected[i].frame_index);
    EXPECT_EQ(found[i].stamp_s, expected[i].stamp_s);
    EXPECT_TRUE(found[i].trusted);
    const Eigen::Isometry3d gap = expected[i].T_world_camera.inverse() * found[i].T_world_camera;
    EXPECT_LT(gap.translation().norm(), 0.001) << i;  // depth is stored in discrete steps
  }
  EXPECT_EQ(resumed.counts().keyframes, whole.counts().keyframes);
  EXPECT_EQ(resumed.take_keyframe_database().keyframes.size(),
            whole.take_keyframe_database().keyframes.size());
}

TEST(OdometryCheckpoint, TakingOneMovesNoPose) {
  const test::TemporaryFolder folder;
  Odometry plain, watched;
  for (int i = 0; i < 26; ++i) {
    const Frame frame = frame_at(on_path(i, kFrames), i);
    const Tracking expected = plain.track(frame), found = watched.track(frame);
    EXPECT_TRUE(found.T_world_camera.matrix() == expected.T_world_camera.matrix()) << i;
    watched.finish_jobs();
    save_odometry(watched, folder_in(folder, std::to_string(i).c_str()), {});
  }
  const std::vector<TrackedFrame> expected = plain.optimise(), found = watched.optimise();
  EXPECT_GT(plain.counts().keyframes, 2);
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_TRUE(found[i].T_world_camera.matrix() == expected[i].T_world_camera.matrix()) << i;
}

TEST(OdometryCheckpoint, OnlyWhatIsNewIsWrittenAgain) {
  const test::TemporaryFolder folder;
  const fs::path first = folder_in(folder, "a"), second = folder_in(folder, "b");
  Odometry odometry;
  track(odometry, 0, 16);
  odometry.finish_jobs();
  save_odometry(odometry, first, {});
  track(odometry, 16, 22);
  odometry.finish_jobs();
  save_odometry(odometry, second, first);
  int linked = 0, fresh = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(second)) {
    ++(entry.hard_link_count() > 1 ? linked : fresh);
  }
  EXPECT_GT(linked, 3);
  EXPECT_GT(fresh, 2);  // the state, a new keyframe and its map keyframe
  fs::remove_all(first);
  EXPECT_EQ(load_odometry(second, {}).counts().frames, 22);
}

TEST(OdometryCheckpoint, GivenPosesComeBackToo) {
  const test::TemporaryFolder folder;
  Odometry odometry;
  for (int i = 0; i < 10; ++i) odometry.add_posed(frame_at(on_path(i, 10), i), on_path(i, 10));
  save_odometry(odometry, folder.path(), {});
  Odometry resumed = load_odometry(folder.path(), {});
  const std::vector<TrackedFrame> all = resumed.optimise();
  ASSERT_EQ(all.size(), 10U);
  EXPECT_TRUE(all[7].T_world_camera.isApprox(on_path(7, 10)));
  EXPECT_EQ(resumed.take_keyframe_database().keyframes.size(),
            odometry.take_keyframe_database().keyframes.size());
}

TEST(OdometryCheckpoint, AnEmptyOneIsEmptyAgain) {
  const test::TemporaryFolder folder;
  save_odometry(Odometry(), folder.path(), {});
  Odometry odometry = load_odometry(folder.path(), {});
  EXPECT_TRUE(odometry.optimise().empty());
  track(odometry, 0, 2);
}

TEST(OdometryCheckpoint, WhatIsCutAlteredOrMissingIsNamed) {
  const test::TemporaryFolder folder;
  Odometry odometry;
  track(odometry, 0, 12);
  odometry.finish_jobs();
  save_odometry(odometry, folder.path(), {});
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path())) {
    ++files;
    const std::string whole = read_bytes(entry.path()), name = entry.path().filename().string();
    const auto refusal = [&] {
      return test::error_of([&] { [[maybe_unused]] const Odometry o = load_odometry(folder.path(), {}); });
    };
    for (const std::size_t size : {std::size_t{0}, std::size_t{10}, whole.size() / 2, whole.size() - 1}) {
      write_bytes(entry.path(), whole.substr(0, size));
      EXPECT_NE(refusal().find(name), std::string::npos) << name << " cut to " << size;
    }
    std::string altered = whole;
    altered[whole.size() / 3] = static_cast<char>(altered[whole.size() / 3] ^ 4);
    write_bytes(entry.path(), altered);
    EXPECT_NE(refusal().find("altered"), std::string::npos) << name;
    fs::remove(entry.path());
    EXPECT_NE(refusal().find(name), std::string::npos) << name << " missing";
    write_bytes(entry.path(), whole);
  }
  EXPECT_GT(files, 4);
  EXPECT_EQ(load_odometry(folder.path(), {}).counts().frames, 12);
}

TEST(OdometryCheckpoint, AFolderThatIsNotThereIsNamed) {
  EXPECT_NE(test::error_of([] { save_odometry(Odometry(), "/no/such/folder", {}); }).find("/no/such/folder"),
            std::string::npos);
}

KeyframeDatabase places_of_the_room() {
  Odometry mapped;
  for (int i = 0; i < 20; ++i) mapped.add_posed(frame_at(on_path(i, 20), i), on_path(i, 20));
  return mapped.take_keyframe_database();
}

TEST(OdometryThatKnowsAMap, IsInTheMapsWorldFromTheFirstFrameOn) {
  Odometry odometry;
  odometry.set_prior_map(places_of_the_room());
  EXPECT_FALSE(odometry.state().located);
  std::vector<TimedPose> truth;
  for (int i = 20; i < 36; ++i) {
    truth.push_back({i, i / 30.0, on_path(i, kFrames)});
    EXPECT_TRUE(odometry.track(frame_at(truth.back().T_world_camera, 100 + i)));
  }
  EXPECT_TRUE(odometry.state().located);
  const std::vector<TrackedFrame> found = odometry.optimise();
  EXPECT_GT(odometry.counts().anchored, 2);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Eigen::Isometry3d error = truth[i].T_world_camera.inverse() * found[i].T_world_camera;
    EXPECT_LT(error.translation().norm(), 0.01) << i;
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.01) << i;
  }
}

/// Adds a keyframe along x in the tracker's world, localised in the known map at T_known_world times its
/// pose.
void add_anchored(double x_m, const Eigen::Isometry3d& T_known_world, OdometrySnapshot& kept) {
  const Eigen::Isometry3d T_tracker_camera(Eigen::Translation3d(x_m, 0.0, 0.0));
  const Eigen::Isometry3d T_world_tracker =
      kept.graph.keyframes.empty() ? Eigen::Isometry3d::Identity() : kept.graph.keyframes[0].T_world_camera;
  Keyframe keyframe;
  keyframe.T_world_camera = T_world_tracker * T_tracker_camera;
  kept.graph.keyframes.push_back(keyframe);
  kept.current = kept.graph.keyframes.size() - 1;
  KeyframeJobResult result;
  result.graph = kept.graph;
  result.T_known_camera = T_known_world * T_tracker_camera;
  take_over(std::move(result), kept);
}

TEST(OdometryThatKnowsAMap, TheFirstAnchorIsOutvotedByTwoThatAgree) {
  const Eigen::Isometry3d T_known_world(Eigen::Translation3d(2.0, 1.0, 0.0) *
                                        Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()));
  const Eigen::Isometry3d by_moved_table = Eigen::Translation3d(0.6, -0.2, 0.0) * T_known_world;
  OdometrySnapshot kept;
  add_anchored(0.0, by_moved_table, kept);
  EXPECT_TRUE(kept.graph.keyframes[0].T_world_camera.isApprox(by_moved_table));
  add_anchored(0.5, T_known_world, kept);
  EXPECT_TRUE(kept.graph.keyframes[0].T_world_camera.isApprox(by_moved_table));  // one against one
  EXPECT_EQ(agreeing_anchors(kept.graph).size(), 1U);
  add_anchored(1.0, T_known_world, kept);
  EXPECT_TRUE(kept.graph.keyframes[0].T_world_camera.isApprox(T_known_world));
  EXPECT_EQ(agreeing_anchors(kept.graph).size(), 2U);
  add_anchored(1.5, by_moved_table, kept);  // two against two: nothing moves
  EXPECT_TRUE(kept.graph.keyframes[0].T_world_camera.isApprox(T_known_world));
  EXPECT_EQ(kept.counts.anchored, 4);
}

TEST(OdometryThatKnowsAMap, AnotherRoomIsTrackedInAWorldOfItsOwn) {
  const test::Scene other =
      test::nearest_of(test::plane({0, 0, 1}, -0.3),
                       test::nearest_of(test::plane({0.3, 1, 0}, 1.9), test::sphere({-0.4, 1.2, 0.4}, 0.5)));
  Odometry odometry;
  odometry.set_prior_map(places_of_the_room());
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d T = on_path(i, kFrames);
    EXPECT_TRUE(odometry.track(frame_at(T, i, other)));
  }
  const std::vector<TrackedFrame> found = odometry.optimise();
  EXPECT_FALSE(odometry.state().located);
  EXPECT_TRUE(found[0].T_world_camera.isApprox(Eigen::Isometry3d::Identity()));
}

}  // namespace
}  // namespace roomradar::odometry_checkpoint_test
