// submap_join_test.cpp: two recordings of one place are joined; places that only seem to be one are not.
#include "mapping/building/submap_join.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mapping/building/keyframe_retrieval.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/noisy_room.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::submap_join_test {
namespace {

constexpr int kKeyframes = 14;

/// World b in world a.
Eigen::Isometry3d T_a_b() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  T.translation() = Eigen::Vector3d(4.0, -1.5, 0.02);
  return T;
}

/// Camera i on a way along the room, from one side to the other.
Eigen::Isometry3d along_room(int i, double aside_m) {
  const double x = -1.0 + 2.0 * i / (kKeyframes - 1);
  return test::looking_at({x, -0.4 + aside_m, 1.2}, {0.9 * x, 2.0, 0.5});
}

/// A submap of the painted room, in a world of its own.
/// @param painted_aside_m  by keyframe: how far the paint is aside of where it is in the room
template <typename Paint>
Submap submap_of(const Eigen::Isometry3d& T_own_room, double aside_m, int noise, const test::Scene& scene,
                 const Paint& painted_aside_m) {
  Submap submap;
  submap.source = "painted room";
  submap.frames_read = kKeyframes;
  for (int i = 0; i < kKeyframes; ++i) {
    const Eigen::Isometry3d T_room_camera = along_room(i, aside_m);
    Frame frame = test::exact_frame(scene, test::kRoomCamera, T_room_camera);
    Eigen::Isometry3d T_paint = T_room_camera;
    T_paint.pretranslate(Eigen::Vector3d::Constant(painted_aside_m(i)));
    test::paint(frame, T_paint);
    test::add_depth_noise(frame, static_cast<unsigned>(noise + i));
    frame.index = i;
    const Eigen::Isometry3d T_own_camera = T_own_room * T_room_camera;
    submap.trajectory.push_back({i, i / 30.0, T_own_camera});
    submap.keyframes.keyframes.push_back(make_map_keyframe(frame, T_own_camera));
  }
  return submap;
}

Submap submap_of(const Eigen::Isometry3d& T_own_room, double aside_m, int noise,
                 const test::Scene& scene = test::room()) {
  return submap_of(T_own_room, aside_m, noise, scene, [](int) { return 0.0; });
}

const Submap& submap_a() {
  static const Submap a = submap_of(Eigen::Isometry3d::Identity(), 0.0, 0);
  return a;
}

std::vector<SubmapJoin> joined(const Submap& a, const Submap& b) {
  return join_submaps(a, b, similar_keyframes(a, b));
}

TEST(SubmapJoin, FindsTheRelativePoseOfTwoRecordingsOfOneRoom) {
  const Submap b = submap_of(T_a_b().inverse(), 0.15, 100);
  const std::vector<SubmapJoin> joins = joined(submap_a(), b);
  ASSERT_EQ(joins.size(), 1U);
  const SubmapJoin& join = joins.front();
  ASSERT_EQ(join.status, JoinStatus::kJoined) << describe(join);
  EXPECT_GE(join.agreeing, 6);
  EXPECT_GE(join.recognised, join.expected - 1);
  EXPECT_GT(join.agreement, 0.95);
  EXPECT_LT((join.T_a_b.translation() - T_a_b().translation()).norm(), 0.05);
  ASSERT_GE(join.links.size(), 4U);
  for (const KeyframeLink& link : join.links) {
    const Eigen::Isometry3d T_true = submap_a().keyframes.keyframes[link.a].T_world_camera.inverse() *
                                     T_a_b() * b.keyframes.keyframes[link.b].T_world_camera;
    const Eigen::Isometry3d error = link.T_a_b.inverse() * T_true;
    EXPECT_LT(error.translation().norm(), 0.015) << "aligned depth is better than features";
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.01);
  }
}

TEST(SubmapJoin, ARoomThatLooksDifferentNearbyIsAnotherOne) {
  // The same furniture; the first half of the walls has the same paint, the rest another.
  const Submap b = submap_of(T_a_b().inverse(), 0.05, 200, test::room(),
                             [](int i) { return i < kKeyframes / 2 ? 0.0 : 0.37; });
  const std::vector<SubmapJoin> joins = joined(submap_a(), b);
  ASSERT_FALSE(joins.empty());
  for (const SubmapJoin& join : joins) {
    EXPECT_EQ(join.status, JoinStatus::kLooksDifferent) << describe(join);
    EXPECT_TRUE(join.links.empty());
  }
}

// Both recordings go on into a second room, 4 m away, whose paint differs.
TEST(SubmapJoin, TwinRoomsWithDifferentNeighboursKeepTheLinksOfWhatLooksAlike) {
  const auto with_neighbour = [](Submap submap, const Eigen::Isometry3d& T_own_room, int noise,
                                 double painted_aside_m) {
    Eigen::Isometry3d T_own_next = T_own_room;
    T_own_next.translate(Eigen::Vector3d(4.0, 0.0, 0.0));
    const Submap next =
        submap_of(T_own_next, 0.05, noise, test::room(), [=](int) { return painted_aside_m; });
    for (const MapKeyframe& keyframe : next.keyframes.keyframes)
      submap.keyframes.keyframes.push_back(keyframe);
    return submap;
  };
  const Eigen::Isometry3d T_b_room = T_a_b().inverse(), T_a_room = Eigen::Isometry3d::Identity();
  const Submap a = with_neighbour(submap_a(), T_a_room, 400, 0.71);
  const Submap b = with_neighbour(submap_of(T_b_room, 0.05, 500), T_b_room, 600, 0.37);
  const std::vector<SubmapJoin> joins = joined(a, b);
  ASSERT_EQ(joins.size(), 1U);
  const SubmapJoin& join = joins.front();
  EXPECT_EQ(join.status, JoinStatus::kLooksDifferent) << describe(join);
  ASSERT_GE(join.links.size(), 4U);
  for (const KeyframeLink& link : join.links) {
    EXPECT_LT(link.a, static_cast<std::size_t>(kKeyframes));
    EXPECT_LT(link.b, static_cast<std::size_t>(kKeyframes));
  }
}

TEST(SubmapJoin, ARoomWithSpaceWhereTheOtherHasSurfaceIsAnotherOne) {
  // The same paint on the wall ahead, but half a metre of the room's right side is filled.
  const test::Scene filled = test::nearest_of(
      test::room(),
      test::box(Eigen::AlignedBox3d(Eigen::Vector3d(-1.7, 0.7, 0), Eigen::Vector3d(1.7, 1.0, 0.9))));
  const Submap b = submap_of(T_a_b().inverse(), 0.05, 300, filled);
  for (const SubmapJoin& join : joined(submap_a(), b)) {
    EXPECT_NE(join.status, JoinStatus::kJoined) << describe(join);
    EXPECT_TRUE(join.links.empty());
  }
}

TEST(SubmapJoin, NoCandidatesAndNoFeaturesAreNoJoin) {
  Submap dark = submap_a();
  for (MapKeyframe& keyframe : dark.keyframes.keyframes) {
    keyframe.descriptors.clear();
    keyframe.points_camera.clear();
  }
  EXPECT_TRUE(similar_keyframes(submap_a(), dark).empty());
  const std::vector<SubmapJoin> none = joined(submap_a(), dark);
  ASSERT_EQ(none.size(), 1U);
  EXPECT_EQ(none.front().status, JoinStatus::kNotRecognised);
}

TEST(SubmapJoin, FilesAreReadAsWrittenAndRefusedIfDamaged) {
  const test::TemporaryFolder folder;
  const Submap& a = submap_a();
  save_submap(a, folder.path());
  const Submap read = load_submap(folder.path());
  ASSERT_EQ(read.keyframes.keyframes.size(), a.keyframes.keyframes.size());
  EXPECT_EQ(read.trajectory.back().T_world_camera.matrix(), a.trajectory.back().T_world_camera.matrix());
  EXPECT_EQ(load_submap_poses(folder.path()).keyframes.keyframes[3].T_world_camera.matrix(),
            a.keyframes.keyframes[3].T_world_camera.matrix());
  const std::vector<SubmapJoin> joins = join_submaps(a, a, {});
  save_joins(joins, folder.path() / "joins.bin");
  EXPECT_EQ(load_joins(folder.path() / "joins.bin").size(), joins.size());
  for (const char* name : {"submap.bin", "keyframes.bin", "joins.bin"}) {
    const std::filesystem::path path = folder.path() / name;
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 9);
  }
  EXPECT_THROW(static_cast<void>(load_submap_poses(folder.path())), Error);
  EXPECT_THROW(static_cast<void>(load_submap(folder.path())), Error);
  EXPECT_THROW(static_cast<void>(load_joins(folder.path() / "joins.bin")), Error);
}

TEST(Submap, FramesMoveWithTheKeyframesAroundThem) {
  Submap submap;
  const auto at = [](double x) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translation().x() = x;
    return T;
  };
  for (int i = 0; i <= 20; ++i) submap.trajectory.push_back({i, 0.0, at(0.1 * i)});
  for (const int i : {5, 15}) {
    submap.keyframes.keyframes.emplace_back().frame_index = i;
    submap.keyframes.keyframes.back().T_world_camera = at(0.1 * i);
  }
  const std::vector<Eigen::Isometry3d> moved{at(0.5 + 1.0), at(1.5 + 2.0)};
  const std::vector<TimedPose> corrected = corrected_trajectory(submap, moved);
  ASSERT_EQ(corrected.size(), 21U);
  EXPECT_NEAR(corrected[0].T_world_camera.translation().x(), 1.0, 1e-12) << "as the first keyframe";
  EXPECT_NEAR(corrected[5].T_world_camera.translation().x(), 1.5, 1e-12);
  EXPECT_NEAR(corrected[10].T_world_camera.translation().x(), 1.0 + 1.5, 1e-12) << "half way";
  EXPECT_NEAR(corrected[20].T_world_camera.translation().x(), 2.0 + 2.0, 1e-12) << "as the last keyframe";
  EXPECT_TRUE(corrected_trajectory(submap, {}).empty()) << "poses of another recording";
}

TEST(Submap, IsSplitWhereTrackingWasLost) {
  Submap submap;
  submap.frames_read = 60;
  for (const int i : {0, 1, 2, 3, 4, 8, 9, 10, 30, 31, 32, 33, 34, 35, 50})
    submap.trajectory.push_back({i, 0.0, Eigen::Isometry3d::Identity()});
  submap.recorded = submap.trajectory;
  for (const int i : {0, 9, 33, 50}) submap.keyframes.keyframes.emplace_back().frame_index = i;
  const std::vector<Submap> parts = split_at_losses(submap, 3, 3);
  ASSERT_EQ(parts.size(), 2U) << "three lost frames are bridged; one frame is no part";
  EXPECT_EQ(parts[0].trajectory.size(), 8U);
  EXPECT_EQ(parts[0].keyframes.keyframes.size(), 2U);
  EXPECT_EQ(parts[1].trajectory.front().frame_index, 30);
  EXPECT_EQ(parts[1].recorded.size(), 6U);
  EXPECT_EQ(parts[1].keyframes.keyframes.front().frame_index, 33);
  EXPECT_EQ(parts[1].frames_read, 60);
  EXPECT_TRUE(split_at_losses({}, 3, 3).empty());
}

}  // namespace
}  // namespace roomradar::submap_join_test
