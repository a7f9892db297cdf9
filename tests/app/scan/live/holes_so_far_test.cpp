// holes_so_far_test.cpp: what a running scan has not seen, in a room known exactly, and its numbers.
#include "app/scan/live/holes_so_far.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "mapping/coverage/holes.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/stored_view.hpp"

namespace roomradar::holes_so_far_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr Intrinsics kCamera{320, 240, 292.0, 292.0, 159.5, 119.5};

/// A closed room of 5.06 x 5.06 x 2.6 m with a screen 1.3 m high, which hides what is behind it.
test::Scene room_with_screen() {
  test::Scene room = test::nearest_of(test::plane({0, 0, 1}, 0.0), test::plane({0, 0, 1}, 2.6));
  for (const double side : {-2.53, 2.53})
    room =
        test::nearest_of(room, test::nearest_of(test::plane({1, 0, 0}, side), test::plane({0, 1, 0}, side)));
  return test::nearest_of(room,
                          test::box(Eigen::AlignedBox3d(Vector3d(1.1, -0.6, 0), Vector3d(1.3, 0.6, 1.3))));
}

/// Adds the keyframes of a look round from one place.
void look_round(const Vector3d& eye_world, std::vector<Keyframe>& keyframes) {
  for (int azimuth = 0; azimuth < 12; ++azimuth)
    for (const double rise : {-3.0, -1.0, 0.0, 1.0, 3.0}) {
      const double a = azimuth * std::numbers::pi / 6.0;
      const Isometry3d T_world_camera =
          test::looking_at(eye_world, eye_world + Vector3d(std::cos(a), std::sin(a), rise));
      Keyframe made;
      made.T_world_camera = T_world_camera;
      made.view = test::stored_view(test::exact_frame(room_with_screen(), kCamera, T_world_camera));
      keyframes.push_back(made);
    }
}

TEST(HolesSoFar, AreBehindWhatHides) {
  std::vector<Keyframe> keyframes;
  look_round({-0.5, 0.0, 1.1}, keyframes);
  const std::vector<Hole> holes = holes_so_far(explored_around({-0.5, 0.0, 1.1}, keyframes));
  ASSERT_FALSE(holes.empty());
  for (const Hole& hole : holes) {
    EXPECT_EQ(hole.kind, HoleKind::kUnknownSpace);
    EXPECT_GT(hole.position_world.x(), 1.0) << describe(hole);
    EXPECT_LT(hole.position_world.z(), 1.7) << describe(hole);
    EXPECT_GT(hole.position_world.z(), 0.2) << describe(hole);
  }
  look_round({1.8, -1.6, 1.1}, keyframes);
  look_round({1.8, 1.6, 1.1}, keyframes);
  EXPECT_TRUE(holes_so_far(explored_around({0.0, 0.0, 1.1}, keyframes)).empty());
}

TEST(HolesSoFar, AreTheSameInARotatedWorld) {
  std::vector<Keyframe> keyframes;
  look_round({-0.5, 0.0, 1.1}, keyframes);
  const std::size_t upright = holes_so_far(explored_around({-0.5, 0.0, 1.1}, keyframes)).size();
  const Isometry3d T_world_room(Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitX()));
  for (Keyframe& keyframe : keyframes) keyframe.T_world_camera = T_world_room * keyframe.T_world_camera;
  const ExplorationGrid grid =
      explored_around(T_world_room * Vector3d(-0.5, 0.0, 1.1), keyframes, T_world_room.inverse());
  EXPECT_EQ(holes_so_far(grid).size(), upright);
}

TEST(HolesSoFar, AreNoneWithoutKeyframes) {
  EXPECT_TRUE(holes_so_far(explored_around(Vector3d::Zero(), {})).empty());
}

Hole hole_at(double x) {
  Hole hole;
  hole.position_world = {x, 0.0, 1.0};
  return hole;
}

TEST(NumberedHoles, KeepTheirNumbers) {
  const std::vector<NumberedHole> first = numbered({hole_at(0.0), hole_at(2.0), hole_at(4.0)});
  ASSERT_EQ(first.size(), 3U);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(first[static_cast<std::size_t>(i)].number, i + 1);

  // The first is gone, the others moved and changed places; a new one takes the free number.
  const std::vector<NumberedHole> then = numbered({hole_at(4.1), hole_at(9.0), hole_at(1.9)}, first);
  ASSERT_EQ(then.size(), 3U);
  EXPECT_EQ(then[0].number, 3);
  EXPECT_EQ(then[1].number, 1);
  EXPECT_EQ(then[2].number, 2);

  // Two near the same earlier one: only one of them keeps its number.
  const std::vector<NumberedHole> split = numbered({hole_at(2.1), hole_at(2.2)}, first);
  EXPECT_EQ(split[0].number, 2);
  EXPECT_EQ(split[1].number, 1);
  EXPECT_TRUE(numbered({}, first).empty());
}

}  // namespace
}  // namespace roomradar::holes_so_far_test
