// radar_sunk_test.cpp: queries for objects sunk in a very fine mesh end after bounded work, with valid
// bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "radar/exact/cyber_radar.hpp"
#include "tests/radar/judged_scene.hpp"
#include "tests/radar/shapes.hpp"

namespace roomradar::radar_sunk_test {
namespace {

/// 1 m wide, cells of 2 mm: 500,000 triangles.
const JudgedMesh& fine_ground() {
  static const JudgedMesh ground([] {
    Mesh mesh = shapes::bumpy_ground(500);
    for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= 0.5F;
    return mesh;
  }());
  return ground;
}

JudgedMesh sunk(const Mesh& mesh, std::mt19937& random, double depth_m) {
  Eigen::Isometry3d T(Eigen::AngleAxisd(shapes::random_point(random).x() * M_PI, Eigen::Vector3d::UnitZ()));
  const Eigen::Vector3d at = 0.15 * shapes::random_point(random);
  T.pretranslate(Eigen::Vector3d(at.x(), at.y(), 0.1 - depth_m));
  return JudgedMesh(mesh, T);
}

Contact ask(CyberRadar& radar, const JudgedMesh& object, const Eigen::Vector3d& direction) {
  const SceneTree ground{{&fine_ground().tree, fine_ground().T_world_mesh}, SurfaceKind::kStatic};
  return radar.query(
      {.object = {&object.tree, object.T_world_mesh}, .direction_world = direction, .distance_m = 0.3},
      {.trees = {&ground, 1}, .depths = {}});
}

TEST(RadarSunk, AWayBackThatIsTooLongIsSaidToBeAtLeastAsFarAsWasLooked) {
  std::mt19937 random(6);
  CyberRadar radar;
  const Mesh box = shapes::box({0.2F, 0.2F, 0.2F});
  int cut_short = 0, whole = 0;
  for (int i = 0; i < 60; ++i) {
    const JudgedMesh object = sunk(box, random, 0.01 + 0.001 * (i % 20));
    Eigen::Vector3d direction = shapes::random_point(random);
    direction.z() = i % 3 == 0 ? direction.z() : 0.0;
    direction.normalize();
    const Contact got = ask(radar, object, direction);
    if (got.status != ContactStatus::kOverlap) {
      // No surface that opposes the motion was found: the object leaves, or the work limit was reached first.
      EXPECT_TRUE(got.lower_m == 0.0 || direction.z() > 0.0);
      continue;
    }
    EXPECT_EQ(got.upper_m, got.contact_distance_m);
    EXPECT_LE(got.contact_distance_m, 0.0);
    EXPECT_GE(got.contact_distance_m, -1.5) << "no farther than the ground goes";
    const auto back_by = [&](double path_length_m) {
      Eigen::Isometry3d T = object.T_world_mesh;
      T.pretranslate(-path_length_m * direction);
      return ask(radar, JudgedMesh(box, T), direction);
    };
    if (got.lower_m == -std::numeric_limits<double>::infinity()) {
      ++cut_short;
      if (got.contact_distance_m > -1e-4) continue;
      const Contact still = back_by(-got.contact_distance_m - 1e-4);
      EXPECT_TRUE(still.status == ContactStatus::kOverlap || still.lower_m == 0.0) << i;
    } else {
      ++whole;
      EXPECT_EQ(got.lower_m, got.contact_distance_m);
      const Contact free = back_by(-got.contact_distance_m + 1e-6);
      EXPECT_NE(free.status, ContactStatus::kOverlap) << i;
    }
  }
  EXPECT_GT(cut_short, 5);
  EXPECT_GT(whole, 5);
}

TEST(RadarSunk, AnOverlapIsOfSomethingAndSomewhereOnItHoweverSoonTheSearchIsCutShort) {
  std::mt19937 random(6);
  CyberRadar radar;
  const Mesh ball = shapes::ball(0.1F, 40, 60), box = shapes::box({0.2F, 0.2F, 0.2F});
  int cut_short = 0;
  for (int i = 0; i < 120; ++i) {
    const JudgedMesh object = sunk(i % 2 == 0 ? ball : box, random, 0.01 + 0.004 * (i % 20));
    Eigen::Vector3d direction = shapes::random_point(random);
    direction.z() = i % 3 == 0 ? direction.z() : 0.0;
    const Contact got = ask(radar, object, direction.normalized());
    if (got.status != ContactStatus::kOverlap) continue;
    cut_short += got.lower_m == -std::numeric_limits<double>::infinity() ? 1 : 0;
    EXPECT_EQ(got.touched, SurfaceKind::kStatic) << i;
    EXPECT_LT(got.contact_distance_m, 0.0) << i;
    EXPECT_LT(std::abs(got.point_world.z()), 0.03) << i << ": the ground is no higher nor deeper";
  }
  EXPECT_GT(cut_short, 10);
}

TEST(RadarSunk, LeavingAVeryFineMeshIsFreeForAsMuchAsIsKnownAndAWallAheadIsFound) {
  std::mt19937 random(7);
  CyberRadar radar;
  const Mesh ball = shapes::ball(0.1F, 40, 60);
  const JudgedMesh wall(shapes::floor(1.0F, 0.25F));
  const SceneTree trees[] = {{{&fine_ground().tree, fine_ground().T_world_mesh}, SurfaceKind::kStatic},
                             {{&wall.tree, wall.T_world_mesh}, SurfaceKind::kDynamic}};
  for (int i = 0; i < 10; ++i) {
    const JudgedMesh object = sunk(ball, random, 0.08);
    const Contact alone = ask(radar, object, Eigen::Vector3d::UnitZ());
    EXPECT_EQ(alone.status, ContactStatus::kNoTarget);
    EXPECT_GE(alone.lower_m, 0.0);
    EXPECT_LE(alone.lower_m, 0.3);
    const Contact got = radar.query({.object = {&object.tree, object.T_world_mesh},
                                     .direction_world = Eigen::Vector3d::UnitZ(),
                                     .distance_m = 0.3},
                                    {.trees = trees, .depths = {}});
    // The wall faces up: the object hits it from behind.
    const double truth_m = 0.25 - object.T_world_mesh.translation().z() - 0.1;
    EXPECT_LE(got.lower_m, truth_m + 1e-6);
    EXPECT_GE(got.upper_m, truth_m - 1e-6);
  }
}

}  // namespace
}  // namespace roomradar::radar_sunk_test
