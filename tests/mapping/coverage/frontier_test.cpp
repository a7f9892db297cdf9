// frontier_test.cpp: an unscanned corner is listed at its position; a completely observed room has no holes.
#include "mapping/coverage/frontier.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "mapping/coverage/holes.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::frontier_test {
namespace {

using Eigen::Vector3d;

constexpr Intrinsics kWide{160, 160, 80.0, 80.0, 79.5, 79.5};  // 90 degrees: six views cover all directions
constexpr double kResolution_m = 0.04;
const Eigen::AlignedBox3d kRoom(Vector3d(-2.0, -1.6, 0.0), Vector3d(2.0, 1.6, 2.4));

// The room from inside: a ray hits the point where it leaves the box.
test::Scene inside_of(const Eigen::AlignedBox3d& box) {
  return [box](const Vector3d& from, const Vector3d& direction) {
    const Eigen::Array3d low = (box.min() - from).array() / direction.array();
    const Eigen::Array3d high = (box.max() - from).array() / direction.array();
    return low.max(high).minCoeff();
  };
}

// Six views from each of three positions in the room; points with is_hidden() give no depth.
StaticMap scan(const test::Scene& scene, const std::function<bool(const Vector3d&)>& is_hidden) {
  StaticMap map(kResolution_m);
  for (const Vector3d& eye : {Vector3d(0.1, 0.05, 1.2), Vector3d(-1.1, 0.4, 1.3), Vector3d(1.2, -0.5, 1.1)})
    for (const Vector3d& way : {Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0),
                                Vector3d(0, 0, 1), Vector3d(0, 0, -1)}) {
      const Vector3d up = std::abs(way.z()) > 0.5 ? Vector3d::UnitX() : Vector3d::UnitZ();
      const Eigen::Isometry3d T = test::looking_at(eye, eye + way, up);
      Frame frame = test::exact_frame(scene, kWide, T);
      for (int y = 0; y < frame.depth_m.height; ++y)
        for (int x = 0; x < frame.depth_m.width; ++x) {
          float& depth_m = frame.depth_m.at(x, y);
          if (is_hidden(T * back_project(kWide, x, y, static_cast<double>(depth_m)))) depth_m = 0.0F;
        }
      EXPECT_NE(map.fuse(frame, T), FuseStatus::kInvalidFrame);
    }
  return map;
}

bool nothing_hidden(const Vector3d& /*p*/) { return false; }

TEST(Frontier, ARoomThatWasSeenWholeHasNoHoles) {
  const std::vector<Hole> holes = find_frontier(scan(inside_of(kRoom), nothing_hidden)).holes;
  EXPECT_TRUE(holes.empty());
  for (const Hole& hole : holes) ADD_FAILURE() << describe(hole);
}

TEST(Frontier, ACornerThatWasNotScannedIsTheOneHole) {
  // The corner of +x, +y and the ceiling, 80 cm along each wall. Rays that would end there have no depth, so
  // more than that pyramid stays unknown: all space on those rays from all three positions.
  const Vector3d corner = kRoom.max();
  const auto map = scan(inside_of(kRoom), [&](const Vector3d& p) { return (corner - p).sum() < 0.8; });
  const std::vector<Hole> holes = find_frontier(map).holes;
  ASSERT_EQ(holes.size(), 1U);
  EXPECT_EQ(holes[0].kind, HoleKind::kUnknownSpace);
  EXPECT_LT((holes[0].position_world - corner).norm(), 1.0) << describe(holes[0]);
  // The pyramid's base has 0.55 m2.
  EXPECT_GT(holes[0].area_m2, 0.5);
  EXPECT_LT(holes[0].area_m2, 1.2);
  EXPECT_GT(holes[0].size_m, 0.6);
  EXPECT_LT(holes[0].size_m, 1.8);
  EXPECT_GT(holes[0].look_direction_world.dot((corner).normalized()), 0.5);
  ASSERT_TRUE(holes[0].viewpoint_world);
  EXPECT_TRUE(kRoom.contains(*holes[0].viewpoint_world));
  EXPECT_EQ(map.occupancy_at(*holes[0].viewpoint_world), Occupancy::kFree);
}

TEST(Frontier, TheShadowBehindABoxIsUnknownSpaceInside) {
  // A cupboard 30 cm in front of the wall, as high as the room; no view shows the space behind it.
  const Eigen::AlignedBox3d cupboard(Vector3d(-0.5, 1.1, -0.1), Vector3d(0.5, 1.3, 2.5));
  const auto map = scan(test::nearest_of(inside_of(kRoom), test::box(cupboard)), nothing_hidden);
  const std::vector<Hole> holes = find_frontier(map).holes;
  ASSERT_FALSE(holes.empty());
  for (const Hole& hole : holes) {
    EXPECT_EQ(hole.kind, HoleKind::kUnknownSpace) << describe(hole);
    EXPECT_GT(hole.position_world.y(), 1.1) << describe(hole);
    EXPECT_LT(std::abs(hole.position_world.x()), 1.1) << describe(hole);
  }
}

TEST(Frontier, ARoomWithoutItsCeilingEndsInAnOuterBorder) {
  const auto map = scan(inside_of(kRoom), [](const Vector3d& p) { return p.z() > 2.3; });
  const std::vector<Hole> holes = find_frontier(map).holes;
  ASSERT_FALSE(holes.empty());
  double area_m2 = 0.0;
  for (const Hole& hole : holes) {
    EXPECT_EQ(hole.kind, HoleKind::kOuterBorder) << describe(hole);
    EXPECT_GT(hole.position_world.z(), 0.8) << describe(hole);
    area_m2 += hole.area_m2;
  }
  EXPECT_GT(area_m2, 5.0);  // of 4 x 3.2 m, minus the part cleared by rays to the walls
}

TEST(Frontier, AnEmptyMapHasNone) { EXPECT_TRUE(find_frontier(StaticMap(kResolution_m)).holes.empty()); }

TEST(Frontier, ConfigsOutOfTheirRulesAreRefused) {
  EXPECT_THROW(require_valid(FrontierConfig{.cell_m = 0.0}), Error);
  EXPECT_THROW(require_valid(FrontierConfig{.min_area_m2 = std::nan("")}), Error);
  EXPECT_THROW(require_valid(FrontierConfig{.max_size_m = 0.0}), Error);
  EXPECT_THROW(require_valid(FrontierConfig{.min_enclosed = 2.0}), Error);
  EXPECT_THROW(require_valid(FrontierConfig{.max_open_part = -1.0}), Error);
  EXPECT_NO_THROW(require_valid(FrontierConfig{}));
}

}  // namespace
}  // namespace roomradar::frontier_test
