// scan_parts_test.cpp: a scan goes on in a new part after a loss, and parts that never meet are kept apart.
#include "mapping/scan_parts.hpp"

#include <gtest/gtest.h>

#include "mapping/odometry/odometry.hpp"
#include "tests/support/noisy_room.hpp"

namespace roomradar::scan_parts_test {
namespace {

using test::frame_at, test::on_path;

/// Looks at the wall behind the path of on_path(), which shares no surface with it.
Eigen::Isometry3d elsewhere(int i) {
  return test::looking_at({0.02 * i, 0.6, 1.3}, {0.4 + 0.02 * i, -2.0, 0.6});
}

test::Scene closed_room() {
  using namespace test;
  return nearest_of(nearest_of(room(), plane({0, 1, 0}, -1.8)),
                    box(Eigen::AlignedBox3d(Eigen::Vector3d(0.2, -1.5, 0), Eigen::Vector3d(0.9, -1.0, 0.6))));
}

TEST(ScanParts, ALossBeginsANewPartAtOnce) {
  constexpr int kFirst = 20, kSecond = 12;
  Odometry odometry;
  for (int i = 0; i < kFirst; ++i) EXPECT_TRUE(odometry.track(frame_at(on_path(i, 60), i, closed_room())));
  EXPECT_EQ(odometry.current_part(), 0);
  for (int i = 0; i < kSecond; ++i) {
    EXPECT_TRUE(odometry.track(frame_at(elsewhere(i), kFirst + i, closed_room()))) << i;
    EXPECT_EQ(odometry.current_part(), 1) << i;
  }
  std::vector<TrackedFrame> frames = odometry.optimise();
  KeyframeDatabase keyframes = odometry.take_keyframe_database();
  const std::size_t all_keyframes = keyframes.keyframes.size();
  // Within the second part, relative poses are right.
  const Eigen::Isometry3d moved = frames[kFirst].T_world_camera.inverse() * frames.back().T_world_camera;
  const Eigen::Isometry3d truth = elsewhere(0).inverse() * elsewhere(kSecond - 1);
  EXPECT_LT((moved.translation() - truth.translation()).norm(), 0.01);
  int main_part = -1;
  const std::vector<ScanPart> parts = join_parts(frames, keyframes, false, main_part);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(main_part, 0);
  EXPECT_TRUE(parts[0].is_joined);
  EXPECT_FALSE(parts[1].is_joined);
  EXPECT_EQ(parts[1].first, kFirst);
  EXPECT_EQ(parts[1].last, kFirst + kSecond - 1);
  EXPECT_EQ(parts[1].frames, kSecond);
  for (const TrackedFrame& frame : frames) EXPECT_EQ(frame.trusted, frame.frame_index < kFirst);
  EXPECT_LT(keyframes.keyframes.size(), all_keyframes);
  for (const MapKeyframe& keyframe : keyframes.keyframes) EXPECT_LT(keyframe.frame_index, kFirst);
}

TEST(ScanParts, TheLongerPartIsTheMap) {
  constexpr int kFirst = 11, kSecond = 25;
  Odometry odometry;
  for (int i = 0; i < kFirst; ++i) EXPECT_TRUE(odometry.track(frame_at(elsewhere(i), i, closed_room())));
  for (int i = 0; i < kSecond; ++i)
    EXPECT_TRUE(odometry.track(frame_at(on_path(i, 60), kFirst + i, closed_room())));
  std::vector<TrackedFrame> frames = odometry.optimise();
  KeyframeDatabase keyframes = odometry.take_keyframe_database();
  int main_part = -1;
  const std::vector<ScanPart> parts = join_parts(frames, keyframes, false, main_part);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(main_part, 1);
  EXPECT_FALSE(parts[0].is_joined);
  EXPECT_TRUE(parts[1].is_joined);
}

TEST(ScanParts, BackAtThePlaceOfTheLossThePartsAreOne) {
  constexpr int kFirst = 20;
  Odometry odometry;
  int index = 0;
  for (int i = 0; i < kFirst; ++i) EXPECT_TRUE(odometry.track(frame_at(on_path(i, 60), index++)));
  EXPECT_TRUE(odometry.track(frame_at(elsewhere(0), index++, closed_room())));
  EXPECT_EQ(odometry.current_part(), 1);
  const Tracking back = odometry.track(frame_at(on_path(kFirst, 60), index++));
  ASSERT_TRUE(back);
  EXPECT_EQ(odometry.current_part(), 0);
  const Eigen::Isometry3d truth = on_path(0, 60).inverse() * on_path(kFirst, 60);
  EXPECT_LT((back.T_world_camera.translation() - truth.translation()).norm(), 0.01);
}

}  // namespace
}  // namespace roomradar::scan_parts_test
