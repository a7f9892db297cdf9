// sim_building_walk_test.cpp: walks through the simulated building: clear of solids, slow, overlapping, and
// together through all rooms and floors.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <set>

#include "app/sim/building/building.hpp"
#include "app/sim/building/building_walk.hpp"
#include "app/sim/sensor/camera_path.hpp"
#include "app/sim/sensor/simulated_source.hpp"

namespace roomradar::sim_building_walk_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::size_t index_of(int number) { return static_cast<std::size_t>(number); }

/// Limits of a walk, over all times.
struct Walked {
  double length_m = 0.0, duration_s = 0.0, fastest_m_s = 0.0, fastest_turn_deg_s = 0.0, clearance_m = 1e9;
  double lowest_m = 1e9, highest_m = -1e9;  ///< above the floor or step
  std::set<int> rooms, floors;
};

Walked walked(const BuildingPlan& plan, Room& building, int walk, std::uint64_t seed) {
  building.walk = plan_walk(plan, walk);
  Walked result;
  result.duration_s = static_cast<double>(building.walk.size() - 1) * building.walk_step_s;
  const CameraPath path = plan_camera_path(building, CameraPathKind::kScan, seed, result.duration_s);
  constexpr double kStep_s = 0.05;
  for (double t_s = 0.0; t_s + kStep_s <= result.duration_s; t_s += kStep_s) {
    const Isometry3d a = T_world_camera_at(path, t_s), b = T_world_camera_at(path, t_s + kStep_s);
    const Vector3d eye = a.translation(), step = b.translation() - eye;
    result.length_m += step.norm();
    result.fastest_m_s = std::max(result.fastest_m_s, step.norm() / kStep_s);
    const double turn_rad = Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
    result.fastest_turn_deg_s =
        std::max(result.fastest_turn_deg_s, turn_rad / kStep_s * 180.0 / std::numbers::pi);
    result.clearance_m = std::min(result.clearance_m, signed_distance_m(building, eye));
    const auto along = cast_ray(building, eye, step.normalized());
    EXPECT_TRUE(along && along->range_m > step.norm()) << "through a solid at " << eye.transpose();
    const auto place = place_at(plan, eye - Vector3d(0, 0, 1.3));
    if (place) result.floors.insert(place->floor);
    if (place && place->room >= 0) result.rooms.insert(place->room);
    // The height above the floor is that above the walked height, as steps are uneven.
    CameraPath level = path;
    for (WalkPoint& point : level.walk) point.floor_m = 0.0;
    if (std::fmod(t_s, 1.0) < 0.01) {
      const double above_m = T_world_camera_at(level, t_s).translation().z();
      result.lowest_m = std::min(result.lowest_m, above_m);
      result.highest_m = std::max(result.highest_m, above_m);
    }
  }
  return result;
}

void expect_good(const Walked& walk) {
  EXPECT_GT(walk.clearance_m, 0.4);
  EXPECT_LT(walk.fastest_m_s, 0.6);
  EXPECT_GT(walk.length_m / walk.duration_s, 0.3);
  EXPECT_LT(walk.fastest_turn_deg_s, 40.0);
  EXPECT_GT(walk.lowest_m, 1.3);
  EXPECT_LT(walk.highest_m, 1.6);
}

class SimBuildingWalk : public testing::TestWithParam<BuildingSize> {};

TEST_P(SimBuildingWalk, KeepsClearAndVisitsItsRoomsAndAllWalksTogetherVisitAll) {
  const BuildingPlan plan = plan_building(2, GetParam());
  Room building = make_building(plan, 0);
  std::set<int> visited;
  const int walks = covering_walks(plan);
  EXPECT_LE(walks, std::max(1, static_cast<int>(0.6 * GetParam().rooms) + 1));
  for (int i = 0; i < walks; ++i) {
    SCOPED_TRACE(i);
    const Walked walk = walked(plan, building, i, 100 + static_cast<std::uint64_t>(i));
    std::printf("walk %d: %zu rooms, %.0f m, %.0f s, clearance %.2f m, %.2f m/s, %.0f deg/s\n", i,
                walk.rooms.size(), walk.length_m, walk.duration_s, walk.clearance_m, walk.fastest_m_s,
                walk.fastest_turn_deg_s);
    expect_good(walk);
    const std::vector<int> rooms = rooms_of_walk(plan, i);
    EXPECT_GE(rooms.size(), 2U);
    EXPECT_LE(rooms.size(), 4U);
    EXPECT_EQ(walk.rooms, std::set<int>(rooms.begin(), rooms.end()));
    visited.insert(rooms.begin(), rooms.end());
  }
  EXPECT_EQ(visited.size(), plan.rooms.size());
}

TEST_P(SimBuildingWalk, TheRingComesBackToItsStart) {
  const BuildingPlan plan = plan_building(2, GetParam());
  Room building = make_building(plan, 0);
  const Walked walk = walked(plan, building, kRingWalk, 7);
  std::printf("ring: %.0f m, %.0f s, clearance %.2f m\n", walk.length_m, walk.duration_s, walk.clearance_m);
  expect_good(walk);
  const Eigen::Vector2d start = building.walk.front().position_m;
  double nearest_m = 1e9;
  for (std::size_t i = building.walk.size() - 15; i < building.walk.size(); ++i)
    nearest_m = std::min(nearest_m, (building.walk[i].position_m - start).norm());
  EXPECT_LT(nearest_m, 0.5);
  EXPECT_NEAR(building.walk.back().floor_m, 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Sizes, SimBuildingWalk,
                         testing::Values(BuildingSize{2, 2, {}}, BuildingSize{10, 2, {}},
                                         BuildingSize{7, 1, {}}, BuildingSize{40, 2, {}}),
                         [](const auto& each) {
                           return std::to_string(each.param.rooms) + "RoomsOn" +
                                  std::to_string(each.param.floors);
                         });

TEST(SimBuildingWalks, AreConnectedThroughSharedRooms) {
  for (const BuildingSize& size : {BuildingSize{10, 2, {}}, BuildingSize{40, 2, {}}, BuildingSize{300, 4, {}},
                                   BuildingSize{1000, 2, {}}}) {
    const BuildingPlan plan = plan_building(4, size);
    const auto walks = index_of(covering_walks(plan));
    std::vector<std::size_t> group(walks);  // the least walk that a walk is joined to
    std::iota(group.begin(), group.end(), 0U);
    std::size_t by_stairs = 0;
    for (int round = 0; round < 3; ++round)
      for (std::size_t i = 0; i < walks; ++i) {
        const std::vector<int> of_i = rooms_of_walk(plan, static_cast<int>(i));
        std::set<int> floors;
        for (const int room : of_i) floors.insert(plan.rooms[index_of(room)].floor);
        if (round == 0) by_stairs += floors.size() > 1 ? 1 : 0;
        for (std::size_t j = 0; j < walks; ++j) {
          const std::vector<int> of_j = rooms_of_walk(plan, static_cast<int>(j));
          const bool share = std::any_of(of_i.begin(), of_i.end(), [&](int room) {
            return std::find(of_j.begin(), of_j.end(), room) != of_j.end();
          });
          if (share) group[i] = group[j] = std::min(group[i], group[j]);
        }
      }
    EXPECT_EQ(*std::max_element(group.begin(), group.end()), 0U) << size.rooms << " rooms";
    EXPECT_GT(by_stairs, walks / 10);
  }
}

TEST(SimBuildingWalks, ALargeBuildingHasARingOf200m) {
  for (const BuildingSize& size :
       {BuildingSize{160, 2, {}}, BuildingSize{300, 4, {}}, BuildingSize{1000, 2, {}}}) {
    const std::vector<WalkPoint> walk = plan_walk(plan_building(1, size), kRingWalk);
    double length_m = 0.0;
    for (std::size_t i = 1; i < walk.size(); ++i)
      length_m += (walk[i].position_m - walk[i - 1].position_m).norm();
    EXPECT_GT(length_m, 190.0) << size.rooms;
    EXPECT_LT(length_m, 400.0) << size.rooms;
  }
}

TEST(SimBuildingWalks, EveryNumberIsAWalk) {
  const BuildingPlan plan = plan_building(1, {12, 3, {}});
  for (int i = 0; i <= kLastWalk; i += i < 40 ? 1 : 997) {
    const std::vector<int> rooms = rooms_of_walk(plan, i);
    EXPECT_GE(rooms.size(), 2U) << i;
    EXPECT_GT(plan_walk(plan, i).size(), 20U) << i;
  }
  EXPECT_EQ(plan_walk(plan, 3).size(), plan_walk(plan, 3).size());
}

TEST(SimBuildingSource, WalksShareTheWorldAndAreSeenTheSameFromOnePlace) {
  SimulatedSource a(parse_sim_spec("sim:building?rooms=4&width=160&noise=0&walk=0"));
  SimulatedSource b(parse_sim_spec("sim:building?rooms=4&width=160&noise=0&walk=1"));
  Frame from_a, from_b;
  ASSERT_EQ(a.next(from_a).status, ReadStatus::kFrame);
  const Isometry3d pose = *from_a.T_world_camera;
  a.look(0, pose, from_a);
  b.look(0, pose, from_b);
  EXPECT_EQ(from_a.depth_m.pixels, from_b.depth_m.pixels);
  EXPECT_EQ(from_a.colour.pixels, from_b.colour.pixels);
  ASSERT_EQ(b.next(from_b).status, ReadStatus::kFrame);
  EXPECT_GT((from_b.T_world_camera->translation() - pose.translation()).norm(), 0.3);
}

TEST(SimBuildingSource, DeliversTheWholeWalkUnlessFewerFramesAreAskedFor) {
  SimulatedSource whole(parse_sim_spec("sim:building?rooms=2&width=64&rate=2"));
  const auto frames = whole.frame_count().value();
  EXPECT_GT(frames, 100);
  EXPECT_EQ(SimulatedSource(parse_sim_spec("sim:building?rooms=2&width=64&rate=2&frames=7")).frame_count(),
            7);
  EXPECT_EQ(
      SimulatedSource(parse_sim_spec("sim:building?rooms=2&width=64&rate=2&frames=99999")).frame_count(),
      frames);
  const auto doubled = SimulatedSource(parse_sim_spec("sim:building?rooms=2&width=64&rate=4")).frame_count();
  EXPECT_NEAR(static_cast<double>(doubled.value()), 2.0 * static_cast<double>(frames), 3.0);
  Frame last, first;
  ASSERT_TRUE(whole.seek(frames - 1));
  ASSERT_EQ(whole.next(last).status, ReadStatus::kFrame);
  EXPECT_EQ(whole.next(first).status, ReadStatus::kEnd);
}

// Parts that are not seen are left out of a frame's solids; the frame must not show that.
TEST(SimBuildingSource, FramesAreThoseOfAllSolids) {
  SimulatedSource source(parse_sim_spec("sim:building?rooms=10&width=160&noise=0&colour=none&walk=1"));
  Frame frame;
  const auto frames = source.frame_count().value();
  for (std::int64_t index = 0; index < frames; index += frames / 25) {
    ASSERT_TRUE(source.seek(index));
    ASSERT_EQ(source.next(frame).status, ReadStatus::kFrame);
    const Isometry3d& T_world_camera = source.truth().T_world_camera;
    for (int y = 3; y < frame.depth_m.height; y += 13)
      for (int x = 3; x < frame.depth_m.width; x += 13) {
        const Vector3d ray = T_world_camera.linear() * back_project(frame.depth_camera, x, y, 1.0);
        const auto hit = cast_ray(source.room(), T_world_camera.translation(), ray);
        ASSERT_TRUE(hit);
        const float exact_m = source.truth().depth_m.at(x, y);
        if (exact_m > 0.0F)
          EXPECT_NEAR(exact_m, hit->range_m, 1e-5);
        else
          EXPECT_TRUE(hit->range_m < 0.51 || hit->range_m > 7.99);
      }
  }
}

}  // namespace
}  // namespace roomradar::sim_building_walk_test
