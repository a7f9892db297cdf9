// proximity_test.cpp: closest features against known and brute-force distances, and free times that must
// never be too long.
#include "radar/motion/proximity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/radar/shapes.hpp"
#include "tests/support/exact_clearance.hpp"

namespace roomradar::proximity_test {
namespace {

using Vec3 = Eigen::Vector3d;

struct Pair {
  Mesh object, scene;
  TriangleTree object_tree, scene_tree;
  SceneTree tree;

  Pair(const Mesh& object_mesh, const Mesh& scene_mesh, SurfaceKind kind = SurfaceKind::kStatic)
      : object(object_mesh), scene(scene_mesh) {
    object_tree.build_by_place(object);
    scene_tree.build_by_place(scene);
    tree = {{&scene_tree, Eigen::Isometry3d::Identity()}, kind};
  }
  [[nodiscard]] RadarScene radar_scene() const { return {{&tree, 1}, {}}; }
  SurfaceKindMask near(const Eigen::Isometry3d& T, double reach_m, std::vector<ClosestPoint>& points) {
    return near_features({&object_tree, T}, radar_scene(), reach_m, 0, points);
  }
  FreeTime free_time(const Eigen::Isometry3d& T, const RigidMotion& motion, double duration_s,
                     double keep_m) {
    return roomradar::free_time({{&object_tree, T}, motion}, duration_s, keep_m, radar_scene());
  }
  [[nodiscard]] double distance_m(const Eigen::Isometry3d& T) const {
    return exact_clearance(object, T, scene, Eigen::Isometry3d::Identity());
  }
};

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

TEST(Proximity, ABoxOverAFloorIsNearAtItsFourCorners) {
  Pair pair(shapes::box({0.2F, 0.3F, 0.1F}), shapes::floor(2.0F, 0.0F));
  std::vector<ClosestPoint> points;
  EXPECT_EQ(pair.near(at(0, 0, 0.051), 0.002, points), 0U);
  ASSERT_EQ(points.size(), 4U);
  for (const ClosestPoint& p : points) {
    EXPECT_NEAR(p.gap_m, 0.001, 1e-7);
    EXPECT_NEAR(p.normal_world.z(), 1.0, 1e-9);
    EXPECT_NEAR(std::abs(p.point_world.x()), 0.1, 1e-7);
    EXPECT_NEAR(std::abs(p.point_world.y()), 0.15, 1e-7);
    EXPECT_EQ(p.kind, SurfaceKind::kStatic);
  }
  EXPECT_EQ(pair.near(at(0, 0, 0.053), 0.002, points), 0U);
  EXPECT_TRUE(points.empty());
}

/// A level sheet of cells x cells squares over [-1, 1]^2 at z = 0.
Mesh grid(std::uint32_t cells) {
  Mesh mesh;
  for (std::uint32_t j = 0; j <= cells; ++j)
    for (std::uint32_t i = 0; i <= cells; ++i)
      mesh.vertices.emplace_back(2.0F * static_cast<float>(i) / static_cast<float>(cells) - 1.0F,
                                 2.0F * static_cast<float>(j) / static_cast<float>(cells) - 1.0F, 0.0F);
  for (std::uint32_t j = 0; j < cells; ++j) {
    for (std::uint32_t i = 0; i < cells; ++i) {
      const std::uint32_t a = j * (cells + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + cells + 1});
      mesh.triangles.push_back({a + 1, a + cells + 2, a + cells + 1});
    }
  }
  return mesh;
}

TEST(Proximity, WhatTouchesExactlyIsNearAndKnowsItsSide) {
  std::vector<ClosestPoint> points;
  // On a floor and under a ceiling, with two triangles and with many: some of these have vertices under the
  // box's edges.
  for (const Mesh& sheet : {shapes::floor(2.0F, 0.0F), grid(32)}) {
    Pair pair(shapes::box({0.25F, 0.5F, 0.125F}), sheet);
    for (const double side : {1.0, -1.0}) {
      EXPECT_EQ(pair.near(at(0.125, 0, side * 0.0625), 0.002, points), 0U);
      ASSERT_GE(points.size(), 4U);
      double widest_m = 0.0;
      for (const ClosestPoint& p : points) {
        EXPECT_EQ(p.gap_m, 0.0);
        EXPECT_EQ(p.normal_world.z(), side) << p.normal_world.transpose();
        widest_m = std::max(widest_m, (p.point_world - points.front().point_world).norm());
      }
      EXPECT_GT(widest_m, 0.5);
    }
  }
}

TEST(Proximity, RoundingDoesNotTurnTheNormalOfWhatTouches) {
  Pair pair(shapes::box({0.25F, 0.5F, 0.125F}), shapes::floor(2.0F, 0.0F));
  Eigen::Isometry3d T = at(0, 0, 0.0625);
  T.rotate(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  T.translation().z() = std::nextafter(0.0625, 1.0);
  std::vector<ClosestPoint> points;
  EXPECT_EQ(pair.near(T, 0.002, points), 0U);
  ASSERT_GE(points.size(), 4U);
  for (const ClosestPoint& p : points) EXPECT_EQ(p.normal_world.z(), 1.0);
}

TEST(Proximity, AnEdgeAcrossAnEdgeIsNearWhereTheyPass) {
  // A box rotated so one of its edges is above an edge of another box, at right angles.
  Mesh ridge = shapes::box({4, 0.2F, 0.2F});
  Pair pair(shapes::box({0.2F, 4, 0.2F}), ridge);
  Eigen::Isometry3d T = at(0.02, 0, 0.0);
  T.rotate(Eigen::AngleAxisd(std::numbers::pi / 4.0, Vec3::UnitY()));  // its lowest edge runs along y
  T.translation().z() = 0.1 + std::sqrt(2.0) * 0.1 + 0.001;
  std::vector<ClosestPoint> points;
  EXPECT_EQ(pair.near(T, 0.002, points), 0U);
  ASSERT_GE(points.size(), 2U);  // above both of the ridge's upper edges
  for (const ClosestPoint& p : points) {
    EXPECT_NEAR(p.gap_m, 0.001, 1e-6);
    EXPECT_NEAR(p.normal_world.z(), 1.0, 1e-6);
    EXPECT_NEAR(p.point_world.x(), 0.02, 1e-6);
  }
}

TEST(Proximity, WhatCrossesIsToldByItsKindAndGivesNoPoint) {
  Pair pair(shapes::box({0.2F, 0.2F, 0.2F}), shapes::floor(2.0F, 0.0F), SurfaceKind::kDynamic);
  std::vector<ClosestPoint> points;
  EXPECT_EQ(pair.near(at(0, 0, 0.05), 0.002, points), bit_of(SurfaceKind::kDynamic));
  EXPECT_TRUE(points.empty());
  EXPECT_EQ(near_features({&pair.object_tree, at(0, 0, 0.05)}, pair.radar_scene(), 0.002,
                          bit_of(SurfaceKind::kDynamic), points),
            0U);
}

TEST(Proximity, AOneSidedSurfaceIsNearFromItsOutsideOnly) {
  std::vector<ClosestPoint> points;
  Pair pair(shapes::box({0.2F, 0.2F, 0.2F}), shapes::floor(2.0F, 0.0F), SurfaceKind::kUnknownFrontier);
  pair.near(at(0, 0, 0.101), 0.002, points);
  EXPECT_EQ(points.size(), 4U);
  pair.near(at(0, 0, -0.101), 0.002, points);
  EXPECT_TRUE(points.empty());
  const RigidMotion up{{0, 0, 1}, Vec3::Zero(), Vec3::Zero()};
  EXPECT_EQ(pair.free_time(at(0, 0, -0.101), up, 1.0, 5e-4).free_s, 1.0);
}

TEST(Proximity, TheNearestPointIsAsNearAsTheMeshes) {
  Pair pair(shapes::torus(14, 8, 0.1F, 0.03F, 0.01F), shapes::torus(20, 10, 0.3F, 0.08F, 0.02F));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<ClosestPoint> points;
  int near_ones = 0;
  for (int i = 0; i < 300; ++i) {
    Eigen::Isometry3d T = at(0.4 * unit(random), 0.4 * unit(random), 0.2 * unit(random));
    T.rotate(
        Eigen::AngleAxisd(3.0 * unit(random), Vec3(unit(random), unit(random), unit(random)).normalized()));
    const double distance_m = pair.distance_m(T);
    const bool crosses = pair.near(T, 0.01, points) != 0;
    EXPECT_EQ(crosses, distance_m == 0.0) << i;
    if (crosses) continue;
    for (const ClosestPoint& p : points) EXPECT_GE(p.gap_m, distance_m - 1e-9);
    if (!points.empty()) {
      ++near_ones;
      EXPECT_NEAR(points.front().gap_m, distance_m, 2e-3);  // vertices above vertices are omitted
    }
    if (points.empty() && distance_m < 0.01) {
      EXPECT_GT(distance_m, 0.0);
    }
  }
  EXPECT_GT(near_ones, 10);
}

TEST(Proximity, NoMotionIsFreeForLongerThanItIs) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto vector = [&](double size) {
    return Vec3(size * unit(random), size * unit(random), size * unit(random));
  };
  constexpr double kKeep_m = 5e-4;
  int stopped = 0;
  for (const Mesh& object : {shapes::box({0.2F, 0.1F, 0.05F}), shapes::box({0.4F, 0.004F, 0.004F}),
                             shapes::torus(12, 6, 0.1F, 0.03F, 0.01F)}) {
    Pair pair(object, shapes::torus(16, 8, 0.4F, 0.1F, 0.02F));
    for (int i = 0; i < 60; ++i) {
      Eigen::Isometry3d T(Eigen::Translation3d(vector(0.6)));
      T.rotate(Eigen::AngleAxisd(3.0 * unit(random), vector(1.0).normalized()));
      const double from_m = pair.distance_m(T);
      if (from_m < 1e-3) continue;
      const RigidMotion motion{vector(2.0), vector(i % 3 == 0 ? 0.0 : 20.0), vector(0.05)};
      const FreeTime free = pair.free_time(T, motion, 0.3, kKeep_m);
      ASSERT_GT(free.free_s, 0.0);
      stopped += free.free_s < 0.3;
      EXPECT_EQ(free.limit.kind != SurfaceKind::kNothing, free.free_s < 0.3);
      for (int k = 1; k <= 12; ++k) {
        const double distance_m = pair.distance_m(pose_after(T, motion, free.free_s * k / 12.0));
        ASSERT_GE(distance_m, std::min(kKeep_m, 0.5 * from_m) - 1e-7) << i;
      }
    }
  }
  EXPECT_GT(stopped, 50);
}

TEST(Proximity, FeaturesOverALevelSheetHaveItsNormal) {
  // Beside an edge of the sheet's triangles, the direction across the edge is no normal of the sheet.
  Pair pair(shapes::ball(0.05F, 32, 64), grid(60));
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<ClosestPoint> points;
  for (int i = 0; i < 200; ++i) {
    Eigen::Isometry3d T = at(0.8 * unit(random), 0.8 * unit(random), 0.0505 + 0.0005 * unit(random));
    T.rotate(Eigen::AngleAxisd(3.0 * unit(random), Vec3(unit(random), unit(random), 1).normalized()));
    EXPECT_EQ(pair.near(T, 0.0015, points), 0U);
    EXPECT_FALSE(points.empty());
    for (const ClosestPoint& p : points) EXPECT_GT(p.normal_world.z(), std::cos(0.06)) << i;
    // Towards the sheet at a shallow angle: the feature that ends the motion, too.
    const Vec3 along = Eigen::AngleAxisd(3.0 * unit(random), Vec3::UnitZ()) * Vec3(1.5, 0, -0.15);
    const FreeTime free = pair.free_time(T, {along, Vec3::Zero(), Vec3::Zero()}, 0.1, 0.0005);
    ASSERT_EQ(free.limit.kind, SurfaceKind::kStatic) << i;
    EXPECT_NEAR(free.limit.normal_world.z(), 1.0, 1e-9) << i;
  }
}

/// Two boards, coarse, and the same with sides of many triangles.
struct Boards {
  Pair coarse{shapes::box({0.3F, 0.2F, 0.02F}), shapes::box({0.5F, 0.25F, 0.02F})};
  Pair fine{shapes::box_of_cells({0.3F, 0.2F, 0.02F}, 13), shapes::box_of_cells({0.5F, 0.25F, 0.02F}, 11)};
};

TEST(Proximity, AFaceOfManyTrianglesIsAsNearAsOneOfTwo) {
  Boards boards;
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<ClosestPoint> coarse, fine;
  int near = 0, crossed = 0;
  for (int i = 0; i < 400; ++i) {
    // Above, beyond the border of, or inside the other board; flat, or tilted by up to 1 mm.
    Eigen::Isometry3d T = at(0.4 * unit(random), 0.2 * unit(random), 0.02 + 0.0015 * unit(random));
    T.rotate(Eigen::AngleAxisd(3.0 * unit(random), Vec3::UnitZ()));
    if (i % 2 == 0) T.rotate(Eigen::AngleAxisd(0.005 * unit(random), Vec3(unit(random), 1, 0).normalized()));
    const SurfaceKindMask of_coarse = boards.coarse.near(T, 0.005, coarse),
                          of_fine = boards.fine.near(T, 0.005, fine);
    ASSERT_EQ(of_fine, of_coarse) << i;
    crossed += of_coarse != 0;
    ASSERT_EQ(fine.empty(), coarse.empty()) << i;
    if (coarse.empty()) continue;
    ++near;
    EXPECT_NEAR(fine.front().gap_m, coarse.front().gap_m, 1e-7) << i;
    EXPECT_GE(fine.front().gap_m, boards.coarse.distance_m(T) - 1e-7) << i;
    // The supporting points reach equally far in each direction.
    for (int k = 0; k < 8; ++k) {
      const Vec3 out(std::cos(k * std::numbers::pi / 4), std::sin(k * std::numbers::pi / 4), 0.0);
      const auto farthest = [&](const std::vector<ClosestPoint>& points) {
        double most = -1.0;
        for (const ClosestPoint& p : points)
          if (p.normal_world.z() > 0.9) most = std::max(most, out.dot(p.point_world) - 20.0 * p.gap_m);
        return most;
      };
      EXPECT_NEAR(farthest(fine), farthest(coarse), 1e-5) << i << ", " << k;
    }
  }
  EXPECT_GT(near, 50);
  EXPECT_GT(crossed, 50);
}

TEST(Proximity, NoFaceOfManyTrianglesIsPassed) {
  Boards boards;
  std::mt19937 random(10);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  constexpr double kKeep_m = 5e-4;
  int stopped = 0;
  for (int i = 0; i < 300; ++i) {
    Eigen::Isometry3d T = at(0.3 * unit(random), 0.2 * unit(random), 0.05 + 0.03 * unit(random));
    T.rotate(Eigen::AngleAxisd(3.0 * unit(random), Vec3::UnitZ()));
    if (i % 2 == 0) T.rotate(Eigen::AngleAxisd(0.1 * unit(random), Vec3(unit(random), 1, 0).normalized()));
    const double from_m = boards.coarse.distance_m(T);
    if (from_m < 1e-3) continue;
    const RigidMotion motion{Vec3(unit(random), unit(random), -2.0 + unit(random)),
                             i % 3 == 0 ? Vec3::Zero() : Vec3(5.0 * Vec3(unit(random), unit(random), 0.1)),
                             Vec3::Zero()};
    const double free_s = boards.fine.free_time(T, motion, 0.1, kKeep_m).free_s;
    ASSERT_GT(free_s, 0.0);
    stopped += free_s < 0.1;
    for (int k = 1; k <= 12; ++k) {
      const double distance_m = boards.coarse.distance_m(pose_after(T, motion, free_s * k / 12.0));
      ASSERT_GE(distance_m, std::min(kKeep_m, 0.5 * from_m) - 1e-6) << i;
    }
  }
  EXPECT_GT(stopped, 100);
}

TEST(Proximity, AStraightFallIsFreeUntilItsKeptDistance) {
  Pair pair(shapes::box({0.2F, 0.2F, 0.2F}), shapes::floor(2.0F, 0.0F));
  const RigidMotion fall{{0, 0, -2}, Vec3::Zero(), Vec3::Zero()};
  EXPECT_NEAR(pair.free_time(at(0, 0, 1.1), fall, 10.0, 5e-4).free_s, (1.0 - 5e-4) / 2.0, 1e-6);
  const RigidMotion slide{{3, 0, 0}, Vec3::Zero(), Vec3::Zero()};
  EXPECT_EQ(pair.free_time(at(0, 0, 0.101), slide, 0.2, 5e-4).free_s, 0.2);
}

TEST(Proximity, ATipOverAnEdgeIsFreeForAWholePiece) {
  // The box rotates about its lower edge, a margin above the floor: the gap shrinks only with the square of
  // the angle.
  Pair pair(shapes::box({0.1F, 0.1F, 0.4F}), shapes::floor(2.0F, 0.0F));
  Eigen::Isometry3d T = at(0, 0, 0);
  T.rotate(Eigen::AngleAxisd(0.3, Vec3::UnitY()));
  const Vec3 edge = T * Vec3(0.05, 0, -0.2);
  T.pretranslate(Vec3(0, 0, 0.001) - edge);
  RigidMotion motion;
  motion.angular_rad_s = 2.0 * Vec3::UnitY();
  motion.linear_m_s = motion.angular_rad_s.cross(T.translation() - Vec3(0, 0, 0.001));
  EXPECT_GT(pair.free_time(T, motion, 1.0 / 60.0, 5e-4).free_s, 0.9 / 60.0);
}

TEST(Proximity, RodsEndToEndAreNearAndAreMetFromFarAway) {
  const Mesh rod = shapes::box({1.0F, 0.01F, 0.01F});
  Pair pair(rod, rod);
  std::vector<ClosestPoint> points;
  EXPECT_EQ(pair.near(at(1.001, 0, 0), 0.002, points), 0U);
  EXPECT_FALSE(points.empty());
  EXPECT_EQ(pair.near(at(1.003, 0, 0), 0.002, points), 0U);
  EXPECT_TRUE(points.empty());

  RigidMotion flight;
  flight.linear_m_s = Vec3(-10.0, 0.0, 0.0);
  const double met_s = pair.free_time(at(3, 0, 0), flight, 1.0, 0.001).free_s;
  EXPECT_GT(met_s, 0.15);
  EXPECT_LT(met_s, 0.2);
  RigidMotion round;  // half a turn brings it to the other object
  round.centre_object = Vec3(-1.5, 0.0, 0.0);
  round.angular_rad_s = Vec3(0.0, 0.0, std::numbers::pi);
  EXPECT_LT(pair.free_time(at(3, 0, 0), round, 1.0, 0.001).free_s, 1.0);
}

TEST(Proximity, NothingIsFreeForEverAndNonsenseIsRefused) {
  Pair pair(shapes::box({0.2F, 0.2F, 0.2F}), Mesh{});
  std::vector<ClosestPoint> points;
  EXPECT_EQ(pair.near(at(0, 0, 0), 0.01, points), 0U);
  EXPECT_EQ(pair.free_time(at(0, 0, 0), {{1, 2, 3}, {4, 5, 6}, Vec3::Zero()}, 1e3, 1e-3).free_s, 1e3);
  EXPECT_EQ(pair.free_time(at(0, 0, std::nan("")), {}, 1.0, 1e-3).free_s, 0.0);
  EXPECT_EQ(pair.free_time(at(0, 0, 0), {}, std::nan(""), 1e-3).free_s, 0.0);
}

}  // namespace
}  // namespace roomradar::proximity_test
