// exact_clearance_test.cpp: exact_clearance against distances computed by hand, and against exact_travel.
#include "tests/support/exact_clearance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/radar/shapes.hpp"
#include "tests/support/exact_travel.hpp"

namespace roomradar::exact_clearance_test {
namespace {

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST(ExactClearance, BoxesApartByFaceEdgeAndCorner) {
  const Mesh box = shapes::box({0.5F, 0.5F, 0.5F});
  EXPECT_NEAR(exact_clearance(box, at(0, 0, 0), box, at(0.8, 0.1, 0.2)), 0.3, 1e-12);
  EXPECT_NEAR(exact_clearance(box, at(0, 0, 0), box, at(0.8, 0.9, 0.2)), 0.5, 1e-12);
  EXPECT_NEAR(exact_clearance(box, at(0, 0, 0), box, at(0.7, 0.9, 0.9)), 0.6, 1e-12);
  EXPECT_EQ(exact_clearance(box, at(0, 0, 0), box, at(0.8, 0.1, 0.2), 0.1), 0.1);
}

TEST(ExactClearance, CrossedEdgesAreApartByTheLineBetweenThem) {
  const Mesh box = shapes::box({1.0F, 0.2F, 0.2F});
  for (const double angle : {0.1, 0.7, M_PI / 2}) {
    const Eigen::AngleAxisd on_edge(M_PI / 4, Eigen::Vector3d::UnitX());
    Eigen::Isometry3d upper(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * on_edge);
    upper.pretranslate(Eigen::Vector3d(0, 0, 1));
    EXPECT_NEAR(exact_clearance(box, upper, box, Eigen::Isometry3d(on_edge)), 1.0 - 0.2 * std::sqrt(2.0),
                1e-7)
        << angle;
  }
}

TEST(ExactClearance, FarFromTheOriginIsTheSame) {
  const Mesh box = shapes::box({0.5F, 0.5F, 0.5F});
  EXPECT_NEAR(exact_clearance(box, at(1e6, -1e6, 1e6), box, at(1e6 + 0.8, -1e6 + 0.1, 1e6)), 0.3, 1e-9);
}

TEST(ExactClearance, CrossingIsZeroAndInsideIsNot) {
  const Mesh box = shapes::box({0.5F, 0.5F, 0.5F});
  EXPECT_EQ(exact_clearance(box, at(0, 0, 0), box, at(0.3, 0.2, 0.1)), 0.0);
  const Mesh small = shapes::box({0.25F, 0.25F, 0.25F});
  EXPECT_NEAR(exact_clearance(box, at(0, 0, 0), small, at(0.025, 0, 0)), 0.1, 1e-9);
  EXPECT_TRUE(exact_holds_inside(box, at(0, 0, 0), small, at(0.025, 0, 0)));
  EXPECT_FALSE(exact_holds_inside(small, at(0.025, 0, 0), box, at(0, 0, 0)));
}

TEST(ExactClearance, MovingChangesItByNoMoreThanTheWay) {
  std::mt19937 random(3);
  const Mesh object = shapes::torus(10, 6, 0.2F, 0.07F, 0.02F), scene = shapes::cup(0.3F, 0.4F, 0.05F, 10);
  for (int i = 0; i < 50; ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(shapes::random_point(random));
    const Eigen::Vector3d way = 0.3 * shapes::random_point(random);
    Eigen::Isometry3d T_moved = T;
    T_moved.pretranslate(way);
    EXPECT_LE(std::abs(exact_clearance(object, T, scene, at(0, 0, 0)) -
                       exact_clearance(object, T_moved, scene, at(0, 0, 0))),
              way.norm() + 1e-12);
  }
}

TEST(ExactClearance, IsZeroExactlyWhereTheTravelJudgeSeesACrossing) {
  std::mt19937 random(4);
  const Mesh object = shapes::torus(12, 7, 0.2F, 0.07F, 0.02F),
             scene = shapes::torus(12, 8, 0.3F, 0.1F, 0.03F);
  int inside = 0, outside = 0;
  for (int i = 0; i < 60; ++i) {
    Eigen::Isometry3d T(shapes::random_rotation(random));
    T.pretranslate(0.6 * shapes::random_point(random));
    const Eigen::Vector3d u = shapes::random_point(random).normalized();
    const auto crossings = exact_crossings(object, T, u, scene, at(0, 0, 0));
    for (double contact_distance_m = -0.9; contact_distance_m < 1.0; contact_distance_m += 0.15) {
      bool is_crossing = false;
      bool is_close = false;
      for (const TravelSpan& span : crossings) {
        is_crossing = is_crossing || (span.from_m <= contact_distance_m && contact_distance_m <= span.to_m);
        is_close = is_close || std::abs(span.from_m - contact_distance_m) < 1e-9 ||
                   std::abs(span.to_m - contact_distance_m) < 1e-9;
      }
      if (is_close) continue;
      Eigen::Isometry3d T_moved = T;
      T_moved.pretranslate(contact_distance_m * u);
      EXPECT_EQ(exact_clearance(object, T_moved, scene, at(0, 0, 0)) == 0.0, is_crossing)
          << i << " " << contact_distance_m;
      ++(is_crossing ? inside : outside);
    }
  }
  EXPECT_GT(inside, 50);
  EXPECT_GT(outside, 300);
}

TEST(ExactEncloses, AgreesWithTheShapesOwnFormulas) {
  std::mt19937 random(5);
  const Mesh box = shapes::box({1.0F, 0.5F, 0.25F});
  const Mesh cup = shapes::cup(0.5F, 0.8F, 0.2F, 100);
  const Mesh torus = shapes::torus(100, 40, 0.5F, 0.2F, 0.0F);
  Eigen::Isometry3d T(shapes::random_rotation(random));
  T.pretranslate(Eigen::Vector3d(1e6, 3.0, -5.0));
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d p = 0.8 * shapes::random_point(random);
    const double r = p.head<2>().norm();
    const auto check = [&](const Mesh& mesh, double depth_m) {  // > 0: inside
      if (std::abs(depth_m) < 3e-3) return;  // error of flat faces that approximate a round shape
      EXPECT_EQ(exact_encloses(mesh, T, T * p), depth_m > 0.0) << p.transpose();
      inside += depth_m > 0.0 ? 1 : 0;
    };
    check(box, std::min({0.5 - std::abs(p.x()), 0.25 - std::abs(p.y()), 0.125 - std::abs(p.z())}));
    const double solid_m = std::min({0.5 - r, p.z(), 0.8 - p.z()}), hollow_m = std::min(0.3 - r, p.z() - 0.2);
    check(cup, std::min(solid_m, -hollow_m));
    check(torus, 0.2 - std::hypot(r - 0.5, p.z()));
  }
  EXPECT_GT(inside, 40);
}

TEST(ExactEncloses, ThingsInAHollowAreNotInside) {
  const Mesh cup = shapes::cup(0.1F, 0.2F, 0.01F, 24), ball = shapes::ball(0.04F, 8, 12);
  EXPECT_FALSE(exact_holds_inside(cup, at(0, 0, 0), ball, at(0, 0, 0.1)));
  EXPECT_GT(exact_clearance(cup, at(0, 0, 0), ball, at(0, 0, 0.1)), 0.02);
  const Mesh post = shapes::box({0.05F, 0.05F, 1.0F});
  EXPECT_FALSE(exact_holds_inside(shapes::torus(40, 20, 0.2F, 0.05F, 0.0F), at(0, 0, 0), post, at(0, 0, 0)));
}

}  // namespace
}  // namespace roomradar::exact_clearance_test
