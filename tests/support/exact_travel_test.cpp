// exact_travel_test.cpp: exact_travel on contacts that can be computed by hand.
#include "tests/support/exact_travel.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "mapping/types/system/error.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::exact_travel_test {
namespace {

const Eigen::Vector3d kDown(0, 0, -1);

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST(ExactTravel, BoxAboveFloorTravelsItsClearance) {
  const auto contact_distance_m = exact_travel(shapes::box({0.2F, 0.2F, 0.2F}), at(0.3, 0.1, 1.0), kDown, 2.0,
                                               shapes::floor(2.0F, 0.0F), at(0, 0, 0));
  ASSERT_TRUE(contact_distance_m);
  EXPECT_NEAR(*contact_distance_m, 0.9, 1e-8);  // rounding of 0.1 to float moves the vertices by 1.5e-9
}

TEST(ExactTravel, EdgeMeetsEdge) {
  // Two boxes on their edges, crossed: only edges touch edges.
  const Mesh box = shapes::box({1.0F, 0.2F, 0.2F});
  Eigen::Isometry3d upper(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitX()));
  upper.pretranslate(Eigen::Vector3d(0, 0, 1));
  Eigen::Isometry3d lower(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()) *
                          Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitX()));
  const auto contact_distance_m = exact_travel(box, upper, kDown, 2.0, box, lower);
  ASSERT_TRUE(contact_distance_m);
  EXPECT_NEAR(*contact_distance_m, 1.0 - 0.2 * std::sqrt(2.0), 1e-7);
}

TEST(ExactTravel, CornerMeetsFaceAndFaceMeetsCorner) {
  Mesh spike;  // a tetrahedron that points down to (0, 0, 0)
  spike.vertices = {{0, 0, 0}, {0.1F, 0, 0.3F}, {-0.1F, 0.1F, 0.3F}, {-0.1F, -0.1F, 0.3F}};
  spike.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 3}, {1, 2, 3}};
  const Mesh floor = shapes::floor(1.0F, 0.0F);
  const auto falling = exact_travel(spike, at(0.2, 0.1, 0.5), kDown, 2.0, floor, at(0, 0, 0));
  ASSERT_TRUE(falling);
  EXPECT_NEAR(*falling, 0.5, 1e-12);
  const auto lifted = exact_travel(floor, at(0, 0, 0), -kDown, 2.0, spike, at(0.2, 0.1, 0.5));
  ASSERT_TRUE(lifted);
  EXPECT_NEAR(*lifted, 0.5, 1e-12);
}

TEST(ExactTravel, MissesAndReachesAreTold) {
  const Mesh box = shapes::box({0.2F, 0.2F, 0.2F});
  const Mesh floor = shapes::floor(1.0F, 0.0F);
  EXPECT_FALSE(exact_travel(box, at(3, 0, 1), kDown, 5.0, floor, at(0, 0, 0)));   // beside it
  EXPECT_FALSE(exact_travel(box, at(0, 0, 1), -kDown, 5.0, floor, at(0, 0, 0)));  // away from it
  EXPECT_FALSE(exact_travel(box, at(0, 0, 1), kDown, 0.8, floor, at(0, 0, 0)));   // not far enough
  EXPECT_FALSE(exact_travel(box, at(0, 0, 1), kDown, 5.0, {}, at(0, 0, 0)));
}

TEST(ExactTravel, CrossingNowIsTravelZero) {
  EXPECT_EQ(exact_travel(shapes::box({0.2F, 0.2F, 0.2F}), at(0, 0, 0.05), Eigen::Vector3d(0.3, 0.1, -1), 1.0,
                         shapes::floor(1.0F, 0.0F), at(0, 0, 0)),
            0.0);
}

TEST(ExactTravel, EdgesMeetAtAnyAngleAndFarFromTheOrigin) {
  const Mesh box = shapes::box({1.0F, 0.2F, 0.2F});
  const Eigen::AngleAxisd on_edge(M_PI / 4, Eigen::Vector3d::UnitX());
  for (const double angle : {0.05, 0.3, 0.7, 1.2, M_PI / 2}) {
    for (const double far_m : {0.0, 1e6}) {
      const Eigen::Vector3d place(far_m, -far_m, far_m);
      Eigen::Isometry3d lower(on_edge);
      lower.pretranslate(place);
      Eigen::Isometry3d upper(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * on_edge);
      upper.pretranslate(place + Eigen::Vector3d(0, 0, 1));
      const auto contact_distance_m = exact_travel(box, upper, kDown, 2.0, box, lower);
      ASSERT_TRUE(contact_distance_m);
      EXPECT_NEAR(*contact_distance_m, 1.0 - 0.2 * std::sqrt(2.0), 1e-7) << angle << " " << far_m;
    }
  }
}

TEST(ExactTravel, BallOnASlopeTravelsByItsSlant) {
  // 1 m above a plane inclined by 30 degrees. Straight down: (distance to the plane - radius) / cos 30.
  const Mesh ball = shapes::ball(0.25F, 200, 300);
  Eigen::Isometry3d slope(Eigen::AngleAxisd(M_PI / 6, Eigen::Vector3d::UnitY()));
  const auto contact_distance_m =
      exact_travel(ball, at(0, 0, 1), kDown, 2.0, shapes::floor(4.0F, 0.0F), slope);
  ASSERT_TRUE(contact_distance_m);
  EXPECT_NEAR(*contact_distance_m, 1.0 - 0.25 / std::cos(M_PI / 6), 4e-5);  // the ball's triangles are flat
}

TEST(ExactTravel, BoxesWithTheSameOutlineMeetFaceToFace) {
  const Mesh box = shapes::box({0.25F, 0.5F, 0.125F});
  for (const double turn : {0.0, 0.3}) {  // at 0, all vertices and edges coincide across the direction
    Eigen::Isometry3d lower(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ()));
    Eigen::Isometry3d upper = lower;
    upper.pretranslate(Eigen::Vector3d(0, 0, 1));
    const auto contact_distance_m = exact_travel(box, upper, kDown, 2.0, box, lower);
    ASSERT_TRUE(contact_distance_m) << turn;
    EXPECT_NEAR(*contact_distance_m, 0.875, 1e-12);
  }
}

TEST(ExactCrossings, BoxThroughASlabCrossesItsTwoSkins) {
  const Mesh box = shapes::box({0.25F, 0.25F, 0.5F}), slab = shapes::box({2.0F, 2.0F, 0.0625F});
  const auto crossings = exact_crossings(box, at(0, 0, 1), kDown, slab, at(0, 0, 0));
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_NEAR(crossings[0].from_m, 1.0 - 0.25 - 0.03125, 1e-12);
  EXPECT_NEAR(crossings[0].to_m, 1.0 + 0.25 + 0.03125, 1e-12);
  EXPECT_FALSE(exact_overlap(crossings));

  const auto flat = exact_crossings(shapes::box({0.25F, 0.25F, 0.125F}), at(0, 0, 1), kDown,
                                    shapes::box({2.0F, 2.0F, 0.5F}), at(0, 0, 0));
  ASSERT_EQ(flat.size(), 2U);  // between the shells it is wholly inside and nothing crosses
  EXPECT_NEAR(flat[0].to_m, 1.0 - 0.25 + 0.0625, 1e-12);
  EXPECT_NEAR(flat[1].from_m, 1.0 + 0.25 - 0.0625, 1e-12);
}

TEST(ExactCrossings, OverlapIsAsDeepAsTheWayBack) {
  const Mesh box = shapes::box({0.25F, 0.25F, 0.25F});
  const auto crossings =
      exact_crossings(box, at(0.05, 0, 0.1), kDown, shapes::floor(1.0F, 0.0F), at(0, 0, 0));
  const auto overlap = exact_overlap(crossings);
  ASSERT_TRUE(overlap);
  EXPECT_NEAR(overlap->from_m, -0.025, 1e-12);
  EXPECT_NEAR(overlap->to_m, 0.225, 1e-12);
}

TEST(ExactCrossings, FirstOneAheadIsTheTravel) {
  std::mt19937 random(2);
  const Mesh object = shapes::torus(14, 9, 0.2F, 0.07F, 0.02F), scene = shapes::chair();
  int ahead = 0;
  for (int i = 0; i < 100; ++i) {
    Eigen::Isometry3d T_world_object(shapes::random_rotation(random));
    T_world_object.pretranslate(shapes::random_point(random));
    const Eigen::Vector3d direction = shapes::random_point(random);
    const auto crossings = exact_crossings(object, T_world_object, direction, scene, at(0, 0, 0));
    const auto contact_distance_m = exact_travel(object, T_world_object, direction, 9.0, scene, at(0, 0, 0));
    std::optional<double> expected_m;
    for (const TravelSpan& span : crossings) {
      if (span.to_m >= 0.0 && !expected_m) expected_m = std::max(span.from_m, 0.0);
    }
    EXPECT_EQ(contact_distance_m, expected_m) << i;
    ahead += contact_distance_m ? 1 : 0;
  }
  EXPECT_GT(ahead, 10);
}

TEST(ExactTravel, GridAndBruteForceAgree) {
  std::mt19937 random(1);
  const Mesh object = shapes::torus(14, 9, 0.2F, 0.07F, 0.02F);
  const Mesh scene = shapes::torus(16, 10, 0.3F, 0.1F, 0.03F);
  int contacts = 0;
  for (int i = 0; i < 60; ++i) {
    Eigen::Isometry3d T_world_object(shapes::random_rotation(random));
    T_world_object.pretranslate(0.5 * shapes::random_point(random));
    const Eigen::Isometry3d T_world_scene(shapes::random_rotation(random));
    const Eigen::Vector3d direction = shapes::random_point(random);
    const auto slow =
        exact_travel(object, T_world_object, direction, 1.0, scene, T_world_scene, ExactMethod::kBruteForce);
    const auto fast =
        exact_travel(object, T_world_object, direction, 1.0, scene, T_world_scene, ExactMethod::kGrid);
    EXPECT_EQ(slow, fast) << i;
    contacts += slow ? 1 : 0;
  }
  EXPECT_GT(contacts, 15);
}

TEST(ExactTravel, BadArgumentsAreRefused) {
  const Mesh box = shapes::box({1, 1, 1});
  EXPECT_THROW((void)exact_travel(box, at(0, 0, 0), {0, 0, 0}, 1.0, box, at(0, 0, 0)), Error);
  EXPECT_THROW((void)exact_travel(box, at(0, 0, 0), {0, std::nan(""), 1}, 1.0, box, at(0, 0, 0)), Error);
  EXPECT_THROW(
      (void)exact_travel(box, at(0, 0, 0), kDown, std::numeric_limits<double>::quiet_NaN(), box, at(0, 0, 0)),
      Error);
}

}  // namespace
}  // namespace roomradar::exact_travel_test
