// moved_things_test.cpp: things that vanished at one place and appeared at another.
#include "mapping/map/moved_things.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace roomradar {
namespace {

using Points = std::vector<Eigen::Vector3d>;

/// Points at random on the surface of a box, one per cm2.
void add_box(const Eigen::Vector3d& low, const Eigen::Vector3d& high, Points& points) {
  std::mt19937 random(static_cast<unsigned>(points.size()));
  std::uniform_real_distribution<double> any(0.0, 1.0);
  const Eigen::Vector3d size = high - low;
  for (int axis = 0; axis < 3; ++axis) {
    const double area_m2 = size.prod() / size[axis];
    for (int i = 0; i < static_cast<int>(2e4 * area_m2); ++i) {
      Eigen::Vector3d p(any(random), any(random), any(random));
      p[axis] = i % 2;
      points.push_back(low + size.cwiseProduct(p));
    }
  }
}

/// A chair: a seat and a back at one side.
Points chair() {
  Points points;
  add_box({-0.2, -0.2, 0.4}, {0.2, 0.2, 0.46}, points);
  add_box({-0.2, 0.16, 0.46}, {0.2, 0.2, 0.9}, points);
  return points;
}

Points table() {
  Points points;
  add_box({-0.6, -0.35, 0.68}, {0.6, 0.35, 0.72}, points);
  add_box({-0.04, -0.04, 0.0}, {0.04, 0.04, 0.68}, points);
  return points;
}

Points cup() {
  Points points;
  add_box({-0.04, -0.04, 0.0}, {0.04, 0.04, 0.1}, points);
  return points;
}

Eigen::Isometry3d placed(double x, double y, double deg) {
  return Eigen::Translation3d(x, y, 0.0) *
         Eigen::AngleAxisd(deg * std::numbers::pi / 180.0, Eigen::Vector3d::UnitZ());
}

Change change_of(ChangeKind kind, const Points& points, const Eigen::Isometry3d& T, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 0.004);
  Change change;
  change.kind = kind;
  for (const Eigen::Vector3d& p : points) {
    change.surface_world.push_back(T * p + Eigen::Vector3d(noise(random), noise(random), noise(random)));
    change.box_world.extend(change.surface_world.back());
    change.position_world += change.surface_world.back() / static_cast<double>(points.size());
  }
  return change;
}

TEST(MovedThings, AreFoundWithDistanceAndTurn) {
  for (const double deg : {0.0, 30.0, 90.0, 171.0, -75.0}) {
    const std::vector<Change> changes = {
        change_of(ChangeKind::kVanished, chair(), placed(0.5, 1.0, 20.0), 1),
        change_of(ChangeKind::kAppeared, chair(), placed(1.3, 0.4, 20.0 + deg), 2)};
    const std::vector<MovedThing> moved = find_moved_things(changes);
    ASSERT_EQ(moved.size(), 1U) << deg;
    EXPECT_EQ(moved[0].vanished, 0U);
    EXPECT_EQ(moved[0].appeared, 1U);
    EXPECT_NEAR(moved[0].turned_deg, deg, 1.0);
    const Eigen::Isometry3d truth = placed(1.3, 0.4, 20.0 + deg) * placed(0.5, 1.0, 20.0).inverse();
    const Eigen::Vector3d seat(0.5, 1.0, 0.45);
    EXPECT_LT((moved[0].T_now_before * seat - truth * seat).norm(), 0.01) << deg;
    EXPECT_GT(moved[0].same_shape, 0.9);
  }
}

TEST(MovedThings, SeenFromOtherSidesTheyAreStillFound) {
  Points before, now;  // the back's rear is not seen before, the seat's underside not now
  for (const Eigen::Vector3d& p : chair()) {
    if (p.y() < 0.19) before.push_back(p);
    if (p.z() > 0.41) now.push_back(p);
  }
  const auto moved = find_moved_things({change_of(ChangeKind::kVanished, before, placed(0, 0, 0), 1),
                                        change_of(ChangeKind::kAppeared, now, placed(-0.8, 0.5, 45), 2)});
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_NEAR(moved[0].turned_deg, 45.0, 3.0);
}

TEST(MovedThings, OtherThingsAreNoPair) {
  EXPECT_TRUE(find_moved_things({}).empty());
  EXPECT_TRUE(find_moved_things({change_of(ChangeKind::kVanished, chair(), placed(0, 0, 0), 1),
                                 change_of(ChangeKind::kAppeared, table(), placed(1, 0, 0), 2),
                                 change_of(ChangeKind::kAppeared, cup(), placed(2, 0, 0), 3),
                                 change_of(ChangeKind::kVanished, chair(), placed(3, 0, 0), 4)})
                  .empty());
}

TEST(MovedThings, EachIsPartOfOnePairAtMost) {
  const auto moved = find_moved_things({change_of(ChangeKind::kVanished, chair(), placed(0, 0, 0), 1),
                                        change_of(ChangeKind::kVanished, table(), placed(2, 0, 0), 2),
                                        change_of(ChangeKind::kAppeared, chair(), placed(0.6, 0, 0), 3),
                                        change_of(ChangeKind::kAppeared, chair(), placed(0, 2, 90), 4),
                                        change_of(ChangeKind::kAppeared, table(), placed(2, 1, 30), 5)});
  ASSERT_EQ(moved.size(), 2U);
  for (const MovedThing& thing : moved) EXPECT_EQ(thing.vanished == 1, thing.appeared == 4);
}

TEST(MovedThings, ARoundOrSquareThingIsTurnedLeast) {
  const auto moved = find_moved_things({change_of(ChangeKind::kVanished, cup(), placed(0, 0, 0), 1),
                                        change_of(ChangeKind::kAppeared, cup(), placed(0.5, 0, 0), 2)});
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_NEAR(moved[0].turned_deg, 0.0, 8.0);
}

}  // namespace
}  // namespace roomradar
