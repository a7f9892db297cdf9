// sim_solid_test.cpp: exact distances and rays of solids, against each other and against closed forms; and
// their meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "app/sim/room/room_mesh.hpp"
#include "app/sim/solids/solid.hpp"
#include "app/sim/solids/solid_tree.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar::sim_solid_test {
namespace {

using Eigen::Vector3d;

Vector3d random_point(CounterRandom& random, double reach_m) {
  return {random.uniform(-reach_m, reach_m), random.uniform(-reach_m, reach_m),
          random.uniform(-reach_m, reach_m)};
}

std::vector<Solid> one_of_each() {
  Solid tilted = rounded_box({0.1, -0.2, 0.3}, {0.5, 0.3, 0.2}, 0.05, 0.4);
  tilted.T_world_solid.rotate(Eigen::AngleAxisd(0.7, Vector3d(1, 2, -1).normalized()));
  Solid rounded_can = cylinder({-0.1, 0.1, -0.2}, 0.2, 0.3);
  rounded_can.round_m = 0.04;
  return {box({0.2, 0.1, -0.1}, {0.4, 0.6, 0.3}, 0.5),
          tilted,
          cylinder({0.1, 0.2, -0.3}, 0.25, 0.5),
          sphere({0.1, 0.1, 0.1}, 0.3),
          capsule({-0.2, 0.1, 0.0}, {0.3, 0.2, 0.25}, 0.1),
          rounded_can};
}

TEST(SimSolid, DistancesHaveTheirClosedForms) {
  EXPECT_DOUBLE_EQ(signed_distance_m(sphere({1, 2, 3}, 0.5), {1, 2, 5}), 1.5);
  EXPECT_DOUBLE_EQ(signed_distance_m(sphere({1, 2, 3}, 0.5), {1, 2, 3}), -0.5);
  const Solid cube = box({0, 0, 0}, {2, 2, 2});
  EXPECT_DOUBLE_EQ(signed_distance_m(cube, {1.5, 0, 0}), 0.5);
  EXPECT_DOUBLE_EQ(signed_distance_m(cube, {2, 2, 2}), std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(signed_distance_m(cube, {0.7, 0, 0.2}), -0.3);
  const Solid can = cylinder({0, 0, 0}, 0.5, 2.0);
  EXPECT_DOUBLE_EQ(signed_distance_m(can, {1.5, 0, 1}), 1.0);
  EXPECT_DOUBLE_EQ(signed_distance_m(can, {0.5 + 0.3, 0, 2 + 0.4}), 0.5);
  EXPECT_DOUBLE_EQ(signed_distance_m(can, {0.2, 0, 1}), -0.3);
  EXPECT_NEAR(signed_distance_m(capsule({0, 0, 0}, {1, 0, 0}, 0.1), {0.5, 0.4, 0.3}), 0.4, 1e-12);
  const Solid cushion = rounded_box({0, 0, 0}, {2, 2, 2}, 0.25);
  EXPECT_NEAR(signed_distance_m(cushion, {0, 0, 1.5}), 0.5, 1e-12);
  EXPECT_NEAR(signed_distance_m(cushion, {1, 1, 1}), 0.25 * (std::sqrt(3.0) - 1.0), 1e-12);
}

TEST(SimSolid, RayEndsOnTheSurfaceAndPassesNothingBefore) {
  for (const Solid& solid : one_of_each()) {
    CounterRandom random(7, 1);
    int hits = 0;
    for (int i = 0; i < 2000; ++i) {
      // Every other ray starts within the bounds, in the space left by rounded edges.
      const Vector3d origin = i % 2 == 0
                                  ? random_point(random, 1.5)
                                  : Vector3d(random_point(random, 1.0).cwiseProduct(bounds_half_m(solid)));
      if (signed_distance_local_m(solid, origin) < 0.0) continue;
      const Vector3d direction = random_point(random, 0.4) - origin;
      const double t = ray_entry_local(solid, origin, direction);
      double least_m = std::numeric_limits<double>::infinity();
      for (int step = 0; step <= 200; ++step) {
        const double at = (t > 0.0 ? t : 3.0) * step / 200.0;
        least_m = std::min(least_m, signed_distance_local_m(solid, origin + at * direction));
      }
      EXPECT_GT(least_m, -1e-9) << "the ray went into the solid unnoticed";
      if (t <= 0.0) continue;
      ++hits;
      EXPECT_NEAR(signed_distance_local_m(solid, origin + t * direction), 0.0, 1e-9);
    }
    EXPECT_GT(hits, 300);
  }
}

TEST(SimSolid, NormalIsTheGradientOfTheDistance) {
  constexpr double kStep_m = 1e-6;
  for (const Solid& solid : one_of_each()) {
    CounterRandom random(8, 1);
    for (int i = 0; i < 300; ++i) {
      const Vector3d p = random_point(random, 1.0);
      if (signed_distance_local_m(solid, p) < 1e-3) continue;  // inside, the distance is not smooth
      Vector3d gradient;
      for (int axis = 0; axis < 3; ++axis)
        gradient[axis] = (signed_distance_local_m(solid, p + kStep_m * Vector3d::Unit(axis)) -
                          signed_distance_local_m(solid, p - kStep_m * Vector3d::Unit(axis))) /
                         (2.0 * kStep_m);
      EXPECT_LT((gradient - normal_local(solid, p)).norm(), 1e-4);
    }
  }
}

TEST(SimSolid, RayAlongAFaceOrFromInsideIsNoEntry) {
  const Solid cube = box({0, 0, 0}, {2, 2, 2});
  EXPECT_LT(ray_entry_local(cube, {0, 0, 0}, {1, 0, 0}), 0.0);
  EXPECT_LT(ray_entry_local(cube, {-3, 1.0001, 0}, {1, 0, 0}), 0.0);
  EXPECT_LT(ray_entry_local(cube, {-3, 0, 0}, {-1, 0, 0}), 0.0);
  EXPECT_LT(ray_entry_local(sphere({0, 0, 0}, 1), {-3, 1.0001, 0}, {1, 0, 0}), 0.0);
  EXPECT_DOUBLE_EQ(ray_entry_local(cube, {-3, 0, 0}, {2, 0, 0}), 1.0);
}

TEST(SimSolidTree, ARayWithinAFacesPlaneTouchesWhateverTheSignOfItsZeros) {
  const std::vector<Solid> solids{box({0, 0, 0}, {2, 2, 2})};
  const SolidTree tree(solids);
  for (const double zero : {0.0, -0.0})
    for (const double x : {-1.0, 0.3, 1.0})
      EXPECT_EQ(tree.cast(solids, {x, 0.2, 3.0}, {zero, zero, -1.0}, 10.0).has_value(),
                ray_entry_local(solids[0], {x, 0.2, 3.0}, {zero, zero, -1.0}) > 0.0)
          << x << " " << zero;
}

TEST(SimSolidTree, AgreesWithLookingAtEverySolid) {
  std::vector<Solid> solids;
  CounterRandom random(9, 1);
  for (int i = 0; i < 60; ++i) {
    const Vector3d centre = random_point(random, 3.0);
    solids.push_back(i % 3 == 0   ? sphere(centre, random.uniform(0.05, 0.3))
                     : i % 3 == 1 ? box(centre, {0.3, random.uniform(0.05, 0.8), 0.2}, random.uniform(0, 3))
                                  : capsule(centre, centre + random_point(random, 0.4), 0.1));
  }
  const SolidTree tree(solids);
  for (int i = 0; i < 2000; ++i) {
    const Vector3d p = random_point(random, 4.0);
    double least_m = std::numeric_limits<double>::infinity();
    for (const Solid& solid : solids) least_m = std::min(least_m, signed_distance_m(solid, p));
    EXPECT_DOUBLE_EQ(tree.signed_distance_m(solids, p), least_m);

    const Vector3d direction = random_point(random, 1.0);
    double first = 5.0;
    for (const Solid& solid : solids) {
      const auto R = solid.T_world_solid.linear().transpose();
      const double t = ray_entry_local(solid, R * (p - solid.T_world_solid.translation()), R * direction);
      if (t > 0.0) first = std::min(first, t);
    }
    const auto hit = tree.cast(solids, p, direction, 5.0);
    EXPECT_EQ(hit.has_value(), first < 5.0);
    if (hit) {
      EXPECT_DOUBLE_EQ(hit->range_m, first);
    }
    EXPECT_EQ(tree.is_blocked(solids, p, p + direction), first < 1.0);
  }
}

TEST(SimSolidTree, EmptyHoldsNothing) {
  const SolidTree tree(std::vector<Solid>{});
  EXPECT_FALSE(tree.cast({}, {0, 0, 0}, {1, 0, 0}, 10.0));
  EXPECT_TRUE(std::isinf(tree.signed_distance_m({}, {0, 0, 0})));
}

TEST(SimMesh, EverySolidIsClosedLooksOutwardAndKeepsItsVolume) {
  const std::vector<Solid> solids = one_of_each();
  const double r_can = 0.2, h_can = 0.3, a = 0.04;  // a cylinder dilated by a ball: Steiner's formula
  const double can = std::numbers::pi * (r_can * r_can * h_can + a * (2 * r_can * r_can + 2 * r_can * h_can) +
                                         a * a * (std::numbers::pi * r_can + h_can) + 4.0 / 3.0 * a * a * a);
  const double c = 0.05, x = 0.4, y = 0.2, z = 0.1;
  const double cushion = x * y * z + 2 * c * (x * y + y * z + z * x) +
                         std::numbers::pi * c * c * (x + y + z) + 4.0 / 3.0 * std::numbers::pi * c * c * c;
  const double length = Vector3d(0.5, 0.1, 0.25).norm();
  const double volumes[] = {0.4 * 0.6 * 0.3,
                            cushion,
                            std::numbers::pi * 0.25 * 0.25 * 0.5,
                            4.0 / 3.0 * std::numbers::pi * 0.027,
                            std::numbers::pi * (0.01 * length + 4.0 / 3.0 * 0.001),
                            can};
  for (std::size_t i = 0; i < solids.size(); ++i) {
    Mesh mesh;
    append_mesh(solids[i], {1, 2, 3}, kMeshDeviation_m, mesh);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    double volume = 0.0;
    for (const Triangle& t : mesh.triangles) {
      for (int e = 0; e < 3; ++e) {
        ++edges[{t[static_cast<std::size_t>(e)], t[static_cast<std::size_t>((e + 1) % 3)]}];
      }
      const Vector3d p = mesh.vertices[t[0]].cast<double>(), q = mesh.vertices[t[1]].cast<double>(),
                     s = mesh.vertices[t[2]].cast<double>();
      volume += p.dot(q.cross(s)) / 6.0;
      // A triangle's centre is at most the stated deviation off the surface.
      EXPECT_LT(std::abs(signed_distance_m(solids[i], (p + q + s) / 3.0)), kMeshDeviation_m + 1e-6);
    }
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_EQ(edges.count({edge.second, edge.first}), 1U) << "solid " << i << " is open";
    }
    EXPECT_NEAR(volume, volumes[i], 0.01 * volumes[i]) << "solid " << i;
    EXPECT_EQ(mesh.colours.size(), mesh.vertices.size());
  }
}

}  // namespace
}  // namespace roomradar::sim_solid_test
