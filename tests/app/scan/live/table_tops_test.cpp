// table_tops_test.cpp: the known part of a table top with a box on it.
#include "app/scan/live/table_tops.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/support/exact_depth.hpp"
#include "tests/support/stored_view.hpp"

namespace roomradar::table_tops_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr Intrinsics kCamera{320, 240, 292.0, 292.0, 159.5, 119.5};

Eigen::AlignedBox3d table() { return {Vector3d(-0.6, -0.4, 0.7), Vector3d(0.6, 0.4, 0.74)}; }

test::Scene table_with_box() {
  return test::nearest_of(
      test::plane({0, 0, 1}, 0.0),
      test::nearest_of(test::box(table()), test::box(Eigen::AlignedBox3d(Vector3d(-0.15, -0.1, 0.7),
                                                                         Vector3d(0.15, 0.1, 0.85)))));
}

/// A scan with one anchor, at the world's origin.
struct Scan {
  AnchorPoses T_world_anchor = {Isometry3d::Identity()};
  KnowledgeGrid knowledge;
  LiveModel model;
  std::vector<Keyframe> keyframes;

  void look(const test::Scene& scene, const Vector3d& eye_world, int frames) {
    // A hand moves, so that the pixels that the knowledge uses do not always meet the same cells.
    std::mt19937 random(7);
    std::uniform_real_distribution<double> moved_m(-0.04, 0.04);
    Isometry3d T_world_camera;
    std::shared_ptr<Frame> frame;
    for (int i = 0; i < frames; ++i) {
      T_world_camera = test::looking_at(eye_world, {moved_m(random), moved_m(random), 0.6});
      frame = std::make_shared<Frame>(test::exact_frame(scene, kCamera, T_world_camera));
      knowledge.add(*frame, 0, T_world_camera, *T_world_anchor[0]);
      if (i % 3 == 0) {
        ASSERT_TRUE(model.offer(frame, 0, T_world_camera, true));
        model.finish();
      }
    }
    Keyframe made;
    made.T_world_camera = T_world_camera;
    made.view = test::stored_view(*frame);
    keyframes.push_back(made);
  }
  std::optional<double> known(const Isometry3d& T_level_world = Isometry3d::Identity()) {
    return table_tops_known(model.parts(), T_world_anchor, T_level_world, knowledge,
                            explored_around(Vector3d::Zero(), keyframes, T_level_world));
  }
};

TEST(TableTops, LackWhatABoxHides) {
  Scan scan;
  EXPECT_FALSE(scan.known());
  scan.look(table_with_box(), {0.0, -1.3, 1.5}, 15);
  const std::optional<double> from_one_side = scan.known();
  ASSERT_TRUE(from_one_side);
  EXPECT_LT(*from_one_side, 0.97);
  EXPECT_GT(*from_one_side, 0.7);
  scan.look(table_with_box(), {0.0, 1.3, 1.5}, 15);
  const std::optional<double> from_both_sides = scan.known();
  ASSERT_TRUE(from_both_sides);
  EXPECT_GT(*from_both_sides, 0.97);
}

TEST(TableTops, AreNotKnownWellFromOneFrame) {
  Scan scan;
  for (const double y : {-1.3, 1.3}) scan.look(table_with_box(), {0.0, y, 1.5}, 1);
  const double after_one = scan.known().value();
  for (const double y : {-1.3, 1.3}) scan.look(table_with_box(), {0.0, y, 1.5}, 15);
  EXPECT_LT(after_one, scan.known().value() - 0.2);
}

TEST(TableTops, AreNoneWithoutAFloorOrATable) {
  Scan floor;
  floor.look(test::plane({0, 0, 1}, 0.0), {0.0, -1.3, 1.5}, 10);
  EXPECT_FALSE(floor.known());
  Scan top;  // the lowest level surface in view is taken as the floor
  top.look(test::box(table()), {0.0, -1.3, 1.5}, 10);
  EXPECT_FALSE(top.known());
}

TEST(TableTops, FollowTheUpDirection) {
  Scan scan;
  scan.look(table_with_box(), {0.0, -1.3, 1.5}, 15);
  ASSERT_TRUE(scan.known());
  const Isometry3d on_its_side(Eigen::AngleAxisd(1.57, Vector3d::UnitX()));
  EXPECT_FALSE(scan.known(on_its_side));
}

}  // namespace
}  // namespace roomradar::table_tops_test
