// recognise_place_test.cpp: a frame's place among rooms that look alike.
#include "mapping/localization/recognise_place.hpp"

#include <gtest/gtest.h>

#include "mapping/localization/pose_hypothesis.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/painted_frame.hpp"

namespace roomradar::recognise_place_test {
namespace {

constexpr Intrinsics kCamera{320, 240, 292.5, 292.5, 159.5, 119.5};
const Eigen::Vector3d kTwin_m(0.0, 0.0, 3.0);  // position of the twin, on the next floor

Frame painted(const test::Scene& scene, const Eigen::Isometry3d& T_world_camera) {
  Frame frame = test::exact_frame(scene, kCamera, T_world_camera);
  test::paint(frame, T_world_camera);
  test::add_depth_noise(frame, 7);
  return frame;
}

Eigen::Isometry3d looking_north(double x_m) { return test::looking_at({x_m, -0.3, 1.2}, {x_m, 2.0, 0.6}); }

/// A room and its twin, with keyframes as a walk through each made them.
struct TwinRooms {
  KeyframeDatabase database;

  /// @param above  the keyframe is of the twin
  void add(const test::Scene& scene, const Eigen::Isometry3d& T_room_camera, bool above) {
    MapKeyframe keyframe = make_map_keyframe(painted(scene, T_room_camera), T_room_camera);
    if (above) keyframe.T_world_camera.pretranslate(kTwin_m);
    database.keyframes.push_back(std::move(keyframe));
  }
  void are_known_to_look_alike() {
    const Eigen::Isometry3d T_above_below(Eigen::Translation3d{kTwin_m});
    database.look_alikes.push_back({{0.0, 0.0, 1.2}, T_above_below});
    database.look_alikes.push_back({Eigen::Vector3d(0.0, 0.0, 1.2) + kTwin_m, T_above_below.inverse()});
  }
};

double error_m(const RecognisedPlace& place, const Eigen::Isometry3d& T_world_camera) {
  return (place.T_world_camera.translation() - T_world_camera.translation()).norm();
}

// The walk through the room below did not look north, where the frame does.
TEST(RecognisePlace, AViewThatOnlyTheTwinRoomHasIsAmbiguous) {
  const test::Scene room = test::corner_with_ball();
  const Frame frame = painted(room, looking_north(0.05));
  TwinRooms rooms;
  rooms.add(room, test::looking_at({0.0, 0.5, 1.2}, {-1.8, 0.0, 0.6}), false);
  for (const double x_m : {-0.3, 0.1, 0.3}) rooms.add(room, looking_north(x_m), true);
  ASSERT_EQ(recognise_place(frame, rooms.database).status, PlaceStatus::kFound)
      << "the frame fits the twin room, and nothing says that there are two";
  rooms.are_known_to_look_alike();
  const RecognisedPlace place = recognise_place(frame, rooms.database);
  EXPECT_EQ(place.status, PlaceStatus::kAmbiguous);
  ASSERT_EQ(place.T_world_others.size(), 1U) << "the right pose";
  EXPECT_TRUE(is_near(place.T_world_others[0], looking_north(0.05), 0.03, 0.02));
}

// A cupboard is in the room above only.
TEST(RecognisePlace, WhatDiffersTellsTwinRoomsApart) {
  const test::Scene below = test::corner_with_ball();
  const test::Scene above = test::nearest_of(
      below, test::box(Eigen::AlignedBox3d(Eigen::Vector3d(-0.9, 1.4, 0.0), Eigen::Vector3d(0.9, 2.5, 1.1))));
  TwinRooms rooms;
  for (const double x_m : {-0.3, 0.1, 0.3}) {
    rooms.add(below, looking_north(x_m), false);
    rooms.add(above, looking_north(x_m), true);
  }
  rooms.are_known_to_look_alike();
  Eigen::Isometry3d T_world_above = looking_north(0.05);
  T_world_above.pretranslate(kTwin_m);
  const RecognisedPlace place = recognise_place(painted(above, looking_north(0.05)), rooms.database);
  ASSERT_EQ(place.status, PlaceStatus::kFound);
  EXPECT_LT(error_m(place, T_world_above), 0.03);
  const RecognisedPlace other = recognise_place(painted(below, looking_north(0.05)), rooms.database);
  ASSERT_EQ(other.status, PlaceStatus::kFound);
  EXPECT_LT(error_m(other, looking_north(0.05)), 0.03);
}

TEST(RecognisePlace, LookAlikesElsewhereDoNotMatter) {
  const test::Scene room = test::corner_with_ball();
  TwinRooms rooms;
  for (const double x_m : {-0.3, 0.1, 0.3}) rooms.add(room, looking_north(x_m), false);
  rooms.database.look_alikes.push_back({{20.0, 0.0, 1.2}, Eigen::Isometry3d(Eigen::Translation3d(kTwin_m))});
  const RecognisedPlace place = recognise_place(painted(room, looking_north(0.05)), rooms.database);
  ASSERT_EQ(place.status, PlaceStatus::kFound);
  EXPECT_LT(error_m(place, looking_north(0.05)), 0.03);
}

}  // namespace
}  // namespace roomradar::recognise_place_test
