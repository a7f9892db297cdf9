// sim_room_test.cpp: objects in simulated rooms touch without overlap, meshes are on the surface, there is
// space to move.
#include <gtest/gtest.h>

#include "app/sim/room/room.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::sim_room_test {
namespace {

using Eigen::Vector3d;

class SimRoom : public testing::TestWithParam<std::string> {};

TEST_P(SimRoom, MeshVerticesLieOnTheSurfaceSoNoSolidsOverlap) {
  const Room room = make_room(GetParam());
  const Mesh mesh = room_mesh(room);
  ASSERT_GT(mesh.triangles.size(), 300U);
  double deepest_m = 0.0, farthest_m = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const double distance_m = signed_distance_m(room, mesh.origin + vertex.cast<double>());
    deepest_m = std::min(deepest_m, distance_m);
    farthest_m = std::max(farthest_m, distance_m);
  }
  EXPECT_GT(deepest_m, -1e-6);
  EXPECT_LT(farthest_m, 1e-6);
}

TEST_P(SimRoom, RaysFromFreePointsEndWhereTheDistanceIsZero) {
  const Room room = make_room(GetParam());
  CounterRandom random(3, 3);
  const Vector3d size = room.interior_max_world - room.interior_min_world;
  for (int i = 0; i < 3000; ++i) {
    const Vector3d p = room.interior_min_world +
                       size.cwiseProduct(Vector3d(random.uniform(), random.uniform(), random.uniform()));
    const double clear_m = signed_distance_m(room, p);
    if (clear_m < 1e-6) continue;
    const Vector3d direction =
        Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
    const auto hit = cast_ray(room, p, direction);
    ASSERT_TRUE(hit) << "a ray left the room";
    EXPECT_GE(hit->range_m, clear_m - 1e-9) << "nothing can be nearer than the distance";
    EXPECT_NEAR(signed_distance_m(room, p + hit->range_m * direction), 0.0, 1e-8);
    EXPECT_LT(hit->normal_world.dot(direction), 1e-9);
    EXPECT_NEAR(hit->normal_world.norm(), 1.0, 1e-9);
  }
}

TEST_P(SimRoom, FocusIsASurfaceWithSpaceForATeapot) {
  const Room room = make_room(GetParam());
  EXPECT_NEAR(signed_distance_m(room, room.focus_world), 0.0, 1e-9);
  // A ball of 12 cm radius fits above the focus, and so does its path down from half a metre.
  for (double height_m = 0.121; height_m < 0.5; height_m += 0.01)
    EXPECT_GT(signed_distance_m(room, room.focus_world + Vector3d(0, 0, height_m)), 0.12);
}

TEST_P(SimRoom, WaysOfBallAndPersonAreFree) {
  const Room room = make_room(GetParam());
  const double ball_m = room.ball_from_world.z() > 0.1 ? 0.055 : 0.11;
  for (double part = 0.0; part <= 1.0; part += 0.02) {
    const Vector3d ball = room.ball_from_world + part * (room.ball_to_world - room.ball_from_world);
    EXPECT_NEAR(signed_distance_m(room, ball + Vector3d(0, 0, ball_m)), ball_m, 1e-9)
        << "the ball rolls on something";
    const Vector3d person = room.person_from_world + part * (room.person_to_world - room.person_from_world);
    for (double height_m = 0.45; height_m < 1.7; height_m += 0.1)
      EXPECT_GT(signed_distance_m(room, person + Vector3d(0, 0, height_m)), 0.4);
  }
}

INSTANTIATE_TEST_SUITE_P(EachRoom, SimRoom, testing::ValuesIn(room_names()));

TEST(SimBoardRoom, SolidsDoNotOverlap) {
  const Room room = make_room("board");
  const Mesh mesh = room_mesh(room);
  for (const Eigen::Vector3f& vertex : mesh.vertices)
    EXPECT_GT(signed_distance_m(room, mesh.origin + vertex.cast<double>()), -1e-6);
}

TEST(SimRandomRoom, IsTheSameFromEveryCompiler) {
  const Room room = make_room("random", false, 3);
  EXPECT_EQ(room.solids.size(), 158U);
  const Vector3d first = room.solids[40].T_world_solid.translation();
  EXPECT_NEAR(room.interior_max_world.x(), 3.0554590936570669, 1e-6);
  EXPECT_NEAR(room.interior_max_world.y(), 2.4488149170028208, 1e-6);
  EXPECT_NEAR(room.focus_world.x(), -0.19874239744034761, 1e-6);
  EXPECT_NEAR(first.x(), -0.18226593630082494, 1e-6);
  EXPECT_NEAR(first.z(), 0.84, 1e-6);
}

TEST(SimRandomRoom, SolidsDoNotOverlapAndThereIsRoomToWalkAndScan) {
  std::size_t least = 1'000'000, most = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const Room room = make_room(kRandomRoom, /*crate=*/false, seed);
    least = std::min(least, room.solids.size());
    most = std::max(most, room.solids.size());
    double deepest_m = 0.0;
    const Mesh mesh = room_mesh(room);
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      deepest_m = std::min(deepest_m, signed_distance_m(room, mesh.origin + vertex.cast<double>()));
    EXPECT_GT(deepest_m, -1e-6);
    EXPECT_NEAR(signed_distance_m(room, room.focus_world), 0.0, 1e-9);
    EXPECT_GT(signed_distance_m(room, room.focus_world + Vector3d(0, 0, 0.13)), 0.12);
    for (double part = 0.0; part <= 1.0; part += 0.02) {
      const Vector3d person = room.person_from_world + part * (room.person_to_world - room.person_from_world);
      EXPECT_NEAR(signed_distance_m(room, person + Vector3d(0, 0, 0.11)), 0.11, 1e-9);
      for (double height_m = 0.45; height_m < 1.7; height_m += 0.1)
        EXPECT_GT(signed_distance_m(room, person + Vector3d(0, 0, height_m)), 0.4);
    }
    const CameraPath path = plan_camera_path(room, CameraPathKind::kScan, seed, 24.0);
    for (double t_s = 0.0; t_s < 24.0; t_s += 0.2)
      EXPECT_GT(signed_distance_m(room, T_world_camera_at(path, t_s).translation()), 0.45);
  }
  EXPECT_GT(least, 40U);
  EXPECT_GT(most, least + 20U);
  EXPECT_EQ(make_room(kRandomRoom, false, 3).solids.size(), make_room(kRandomRoom, false, 3).solids.size());
}

TEST(SimRandomRoom, AFifthOfTheFurnitureStandsElsewhereAndTheRestWhereItWas) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const Room before = make_room(kRandomRoom, false, seed), after = make_room(kRandomRoom, false, seed, 0.2);
    EXPECT_EQ(make_room(kRandomRoom, false, seed, 0.2).solids.size(), after.solids.size());
    EXPECT_EQ(before.interior_max_world, after.interior_max_world);
    const auto is_in = [](const Room& room, const Solid& solid) {
      return std::any_of(room.solids.begin(), room.solids.end(), [&](const Solid& other) {
        return other.T_world_solid.isApprox(solid.T_world_solid, 1e-9);
      });
    };
    std::size_t stayed = 0;
    for (const Solid& solid : before.solids) stayed += is_in(after, solid) ? 1 : 0;
    EXPECT_LT(stayed, before.solids.size() - 1);
    EXPECT_GT(2 * stayed, before.solids.size());
    double deepest_m = 0.0;
    const Mesh mesh = room_mesh(after);
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      deepest_m = std::min(deepest_m, signed_distance_m(after, mesh.origin + vertex.cast<double>()));
    EXPECT_GT(deepest_m, -1e-6);
    for (const Solid& solid : after.solids)
      EXPECT_LT(solid.T_world_solid.translation().head<2>().cwiseAbs().maxCoeff(),
                after.interior_max_world.head<2>().maxCoeff() + 0.5);
  }
}

// The walk comes back to where it began, with the view, through all four rooms.
TEST(SimFlat, SolidsDoNotOverlapAndTheWalkGoesThroughAllRoomsClearOfThem) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(seed);
    const Room flat = make_room(kFlatRoom, /*crate=*/false, seed);
    const Mesh mesh = room_mesh(flat);
    for (const Eigen::Vector3f& vertex : mesh.vertices)
      ASSERT_GT(signed_distance_m(flat, mesh.origin + vertex.cast<double>()), -1e-6);
    constexpr double kRound_s = 180.0;
    const CameraPath path = plan_camera_path(flat, CameraPathKind::kScan, seed, kRound_s);
    constexpr double kStep_s = 0.05;
    unsigned rooms = 0;
    for (double t_s = 0.0; t_s < kRound_s; t_s += kStep_s) {
      const Eigen::Isometry3d a = T_world_camera_at(path, t_s), b = T_world_camera_at(path, t_s + kStep_s);
      ASSERT_GT(signed_distance_m(flat, a.translation()), 0.4) << t_s;
      ASSERT_LT((b.translation() - a.translation()).norm(), 0.6 * kStep_s) << t_s;
      const double turn_deg = Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle() * 57.2958;
      EXPECT_LT(turn_deg, 45.0 * kStep_s) << t_s;
      rooms |= 1U << ((a.translation().x() > 0.0 ? 1 : 0) + (a.translation().y() > 0.0 ? 2 : 0));
    }
    EXPECT_EQ(rooms, 0b1111U);
    EXPECT_LT(
        (T_world_camera_at(path, 0.0).translation() - T_world_camera_at(path, kRound_s).translation()).norm(),
        0.4);
  }
}

TEST(SimRoomNames, AnUnknownNameIsRefusedWithTheKnownOnes) {
  try {
    make_room("attic");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("attic"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("table, shelf, wall"), std::string::npos);
  }
}

}  // namespace
}  // namespace roomradar::sim_room_test
