// leaving_overlaps_test.cpp: a body that is moved out of an overlap enters nothing else on the way.
#include <gtest/gtest.h>

#include "app/physics/physics.hpp"
#include "tests/radar/shapes.hpp"
#include "tests/support/body_group.hpp"

namespace roomradar::leaving_overlaps_test {
namespace {

using Vec3 = Eigen::Vector3d;

constexpr double kCube_m = 0.1;

/// A wide plate that is held 20 mm deep in a cube, and above the cube a second one, held too.
test::BodyGroup cube_on_a_plate(double gap_above_m) {
  const Mesh cube = shapes::box(Eigen::Vector3f::Constant(static_cast<float>(kCube_m)));
  test::BodyGroup group({shapes::box({1.0F, 1.0F, 0.01F}), cube, cube});
  group.put(0, {0.0, 0.0, 0.1});
  group.put(1, {0.0, 0.0, 0.135});
  group.put(2, {0.0, 0.0, 0.135 + kCube_m + gap_above_m});
  group.is_carried[0] = group.is_carried[2] = true;
  return group;
}

double gap_above_m(const test::BodyGroup& group) {
  return group.bodies[2].T_world_object.translation().z() - group.bodies[1].T_world_object.translation().z() -
         kCube_m;
}

TEST(LeavingOverlaps, ABodyThatLeavesAnotherEntersNoThird) {
  for (const double gap_m : {0.0015, 0.005, 0.02}) {
    test::BodyGroup group = cube_on_a_plate(gap_m);
    for (int frame = 0; frame < 30; ++frame) {
      group.step({});
      ASSERT_GT(gap_above_m(group), 0.0) << gap_m << " frame " << frame;
    }
  }
}

TEST(LeavingOverlaps, ABodyLeavesAnotherWhereItCan) {
  test::BodyGroup group = cube_on_a_plate(0.1);
  group.step({});
  EXPECT_GT(group.bodies[1].T_world_object.translation().z(), 0.155);
}

}  // namespace
}  // namespace roomradar::leaving_overlaps_test
