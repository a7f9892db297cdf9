// inflated_distance_test.cpp: distance to contact of an inflated triangle against closed forms and against
// exact distances.
#include "radar/geometry/inflated_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/radar/shapes.hpp"
#include "tests/support/exact_clearance.hpp"

namespace roomradar::inflated_distance_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

FrameTriangle triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  FrameTriangle t{{a, b, c}, {}};
  set_normal(t);
  return t;
}

double clearance_m(const FrameTriangle& object, const FrameTriangle& scene, double contact_distance_m) {
  const auto mesh_of = [](const FrameTriangle& t) {
    Mesh mesh;
    for (const Eigen::Vector3d& p : t.corners) mesh.vertices.push_back(p.cast<float>());
    mesh.triangles = {{0, 1, 2}};
    return mesh;
  };
  Eigen::Isometry3d T(Eigen::Translation3d(0, 0, contact_distance_m));
  return exact_clearance(mesh_of(object), T, mesh_of(scene), Eigen::Isometry3d::Identity());
}

TEST(ThickTravel, FaceEdgeAndCornerStopAtTheMargin) {
  const FrameTriangle flat = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_NEAR(inflated_distance(flat, triangle({0, 0, 2}, {1, 0, 2}, {0, 1, 2}), 0.25, 9.0), 1.75, 1e-9);
  // A tip straight ahead, and one 0.3 beside the edge: contact sqrt(0.5^2 - 0.3^2) = 0.4 in front of it.
  EXPECT_NEAR(inflated_distance(flat, triangle({0.2, 0.2, 2}, {1, 1, 5}, {0, 1, 5}), 0.25, 9.0), 1.75, 1e-9);
  EXPECT_NEAR(inflated_distance(flat, triangle({0.5, -0.3, 2}, {0.2, -1, 5}, {0.8, -1, 5}), 0.5, 9.0), 1.6,
              1e-8);
}

TEST(ThickTravel, PassesBesideBehindAndAlongWithoutEnd) {
  const FrameTriangle flat = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(inflated_distance(flat, triangle({3, 0, 2}, {4, 0, 2}, {3, 1, 2}), 0.25, 9.0), kInfinity);
  EXPECT_EQ(inflated_distance(flat, triangle({0, 0, -2}, {1, 0, -2}, {0, 1, -2}), 0.25, 9.0), kInfinity);
  // A long wall parallel to the motion, 0.3 beside it.
  const FrameTriangle wall = triangle({0.5, -0.3, -9}, {0.5, -0.3, 9}, {0.5, -5, 0});
  EXPECT_EQ(inflated_distance(flat, wall, 0.25, 9.0), kInfinity);
  EXPECT_EQ(inflated_distance(flat, wall, 0.31, 9.0), 0.0);
}

TEST(ThickTravel, WithinTheMarginOrCrossingIsZero) {
  const FrameTriangle flat = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_EQ(inflated_distance(flat, triangle({0, 0, 0.2}, {1, 0, 0.2}, {0, 1, 0.2}), 0.25, 9.0), 0.0);
  EXPECT_EQ(inflated_distance(flat, triangle({0, 0, -0.2}, {1, 0, -0.2}, {0, 1, -0.2}), 0.25, 9.0), 0.0);
  EXPECT_EQ(inflated_distance(flat, triangle({0.2, 0.2, -9}, {0.3, 0.2, 9}, {0.2, 0.3, 9}), 1e-9, 9.0), 0.0);
}

TEST(ThickTravel, NeverPassesTheMarginAndStopsAtIt) {
  std::mt19937 random(1);
  int stopped = 0, passed = 0, late = 0;
  for (int i = 0; i < 3000; ++i) {
    const auto point = [&] { return shapes::random_point(random).cast<float>().cast<double>().eval(); };
    const Eigen::Vector3d shift(0, 0, -1.5);
    const FrameTriangle object = triangle(point() + shift, point() + shift, point() + shift);
    FrameTriangle scene = triangle(point(), point(), point());
    if (i % 4 == 0) {  // parallel to the motion
      for (Eigen::Vector3d& p : scene.corners) p.x() = 0.25;
      set_normal(scene);
    }
    if (i % 5 == 0) {  // no area
      scene.corners[2] = scene.corners[1];
      set_normal(scene);
    }
    const double margin_m = std::pow(10.0, -1.0 - i % 5);
    const double contact_distance_m = inflated_distance(object, scene, margin_m, 10.0);
    for (double t = 0.0; t < std::min(contact_distance_m, 4.0); t += 0.05) {
      ASSERT_GT(clearance_m(object, scene, t), margin_m - 1e-6) << i << " at " << t;
    }
    if (!(contact_distance_m < 10.0)) {
      ++passed;
      continue;
    }
    ++stopped;
    late += clearance_m(object, scene, contact_distance_m) > margin_m + 1e-6 ? 1 : 0;
  }
  EXPECT_GT(stopped, 1000);
  EXPECT_GT(passed, 300);
  EXPECT_LE(late, stopped / 500);  // a graze
}

}  // namespace
}  // namespace roomradar::inflated_distance_test
