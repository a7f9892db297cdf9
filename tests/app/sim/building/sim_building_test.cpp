// sim_building_test.cpp: the simulated building: solids that do not overlap, rooms that can all be reached,
// look-alikes, corridors that differ, stairs, and what is seen through doorways.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <queue>
#include <set>

#include "app/sim/building/building.hpp"
#include "app/sim/building/building_walk.hpp"
#include "app/sim/room/room_mesh.hpp"
#include "app/sim/room/room_parts.hpp"
#include "app/sim/solids/solid_distance.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar::sim_building_test {
namespace {

using Eigen::Vector3d;

std::size_t index_of(int number) { return static_cast<std::size_t>(number); }

class SimBuilding : public testing::TestWithParam<BuildingSize> {
 protected:
  BuildingPlan plan_ = plan_building(3, GetParam());
  Room building_ = make_building(plan_, 0);
};

TEST_P(SimBuilding, SolidsDoNotOverlap) {
  const Mesh mesh = room_mesh(building_, 0.01);
  double deepest_m = 0.0;
  Vector3d where = Vector3d::Zero();
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Vector3d p_world = mesh.origin + vertex.cast<double>();
    const double distance_m = signed_distance_m(building_, p_world);
    if (distance_m < deepest_m) where = p_world;
    deepest_m = std::min(deepest_m, distance_m);
  }
  // Vertices are stored as floats: 1e-5 m at 100 m.
  EXPECT_GT(deepest_m, -2e-5) << where.transpose();
}

TEST_P(SimBuilding, RaysFromInsideEndOnASurfaceOfAPartThatIsSeen) {
  CounterRandom random(3, 3);
  const Vector3d size = building_.interior_max_world - building_.interior_min_world;
  int rays = 0;
  while (rays < 2000) {
    const Vector3d p = building_.interior_min_world +
                       size.cwiseProduct(Vector3d(random.uniform(), random.uniform(), random.uniform()));
    if (!place_at(plan_, p) || signed_distance_m(building_, p) < 0.01) continue;
    const double below_ceiling_m = p.z() - std::floor(p.z() / kStoreyHeight_m) * kStoreyHeight_m;
    if (below_ceiling_m > 2.35) continue;  // rooms are 2.4 to 2.8 m high
    const std::vector<int> seen = visible_parts(building_, p);
    const std::set<int> is_seen(seen.begin(), seen.end());
    for (int i = 0; i < 20; ++i, ++rays) {
      const Vector3d direction =
          Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3)).normalized();
      const auto hit = cast_ray(building_, p, direction);
      ASSERT_TRUE(hit) << "a ray left the building at " << p.transpose();
      EXPECT_TRUE(is_seen.contains(part_of_solid(building_, index_of(hit->solid)))) << p.transpose();
    }
  }
}

TEST_P(SimBuilding, AllPartsAreJoinedByOpeningsThatOneCanWalkThrough) {
  std::set<int> reached{0};
  std::queue<int> waiting({0});
  while (!waiting.empty()) {
    const int part = waiting.front();
    waiting.pop();
    for (const PartOpening& opening : building_.parts[index_of(part)].openings) {
      const Eigen::Vector2d middle = 0.5 * (opening.from_m + opening.to_m);
      EXPECT_GT(signed_distance_m(building_, Vector3d(middle.x(), middle.y(), opening.low_m + 1.4)), 0.45);
      if (reached.insert(opening.part).second) waiting.push(opening.part);
    }
  }
  EXPECT_EQ(reached.size(), building_.parts.size());
}

TEST_P(SimBuilding, EachSolidBelongsToThePartAroundIt) {
  for (std::size_t i = 0; i < building_.solids.size(); i += 7) {
    const RoomPart& part = building_.parts[index_of(part_of_solid(building_, i))];
    EXPECT_GE(i, part.solids_begin);
    EXPECT_LT(i, part.solids_end);
    const Eigen::AlignedBox3d bounds = bounds_world(building_.solids[i]);
    EXPECT_LT(part.bounds_world.exteriorDistance(bounds.min()), 1e-6) << i;
    EXPECT_LT(part.bounds_world.exteriorDistance(bounds.max()), 1e-6) << i;
  }
}

TEST_P(SimBuilding, PlacesOfPointsAreThoseOfThePlan) {
  for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
    const PlannedRoom& room = plan_.rooms[i];
    const Vector3d p(room.middle_m.x(), room.middle_m.y(), floor_height_m(room.floor) + 1.5);
    const auto place = place_at(plan_, p);
    ASSERT_TRUE(place);
    EXPECT_EQ(place->room, static_cast<int>(i));
    EXPECT_EQ(place->floor, room.floor);
    EXPECT_EQ(part_at(building_, p), static_cast<int>(i));
  }
  EXPECT_FALSE(place_at(plan_, {5.0, 0.0, -3.0}));
  EXPECT_FALSE(place_at(plan_, {1e300, 0.0, 1.0}));
  const auto corridor = place_at(plan_, {1.0, 0.0, 1.0});
  ASSERT_TRUE(corridor);
  EXPECT_EQ(corridor->room, -1);
}

TEST_P(SimBuilding, RoomsThatLookAlikeAreEqualUpToATranslation) {
  int alike = 0;
  for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
    const int twin = plan_.rooms[i].twin;
    if (twin < 0) continue;
    ++alike;
    EXPECT_EQ(plan_.rooms[index_of(twin)].twin, static_cast<int>(i));
    const RoomPart &a = building_.parts[i], &b = building_.parts[index_of(twin)];
    ASSERT_EQ(a.solids_end - a.solids_begin, b.solids_end - b.solids_begin);
    const Vector3d shift = b.bounds_world.min() - a.bounds_world.min();
    if (plan_.size.floors > 1) {
      EXPECT_LT(shift.head<2>().norm(), 1e-9) << "at the same place in plan";
      EXPECT_NEAR(std::abs(shift.z()), kStoreyHeight_m, 1e-9);
    }
    for (std::size_t k = 0; k < a.solids_end - a.solids_begin; ++k) {
      const Solid &first = building_.solids[a.solids_begin + k],
                  &second = building_.solids[b.solids_begin + k];
      EXPECT_LT((second.T_world_solid.translation() - first.T_world_solid.translation() - shift).norm(),
                1e-9);
      EXPECT_EQ(first.T_world_solid.linear(), second.T_world_solid.linear());
      EXPECT_EQ(first.half_m, second.half_m);
      const Material &paint = building_.materials[a.solids_begin + k],
                     &other = building_.materials[b.solids_begin + k];
      EXPECT_EQ(paint.seed, other.seed);
      EXPECT_EQ(paint.first, other.first);
      EXPECT_EQ(paint.pattern, other.pattern);
    }
  }
  EXPECT_EQ(alike, plan_.size.alike.value_or(2 * (plan_.size.rooms / 10)));
}

TEST_P(SimBuilding, RoomsThatDoNotLookAlikeDiffer) {
  std::set<std::pair<std::size_t, double>> kinds;
  for (std::size_t i = 0; i < plan_.rooms.size(); ++i) {
    const RoomPart& part = building_.parts[i];
    kinds.insert({part.solids_end - part.solids_begin, building_.solids[part.solids_end - 1].half_m.x()});
  }
  const auto pairs = static_cast<std::size_t>(plan_.size.alike.value_or(2 * (plan_.size.rooms / 10)) / 2);
  EXPECT_EQ(kinds.size(), plan_.rooms.size() - pairs);
}

TEST_P(SimBuilding, CorridorsDifferBetweenFloorsAndAlongThem) {
  const std::size_t first = plan_.rooms.size(), pieces = plan_.pieces.size();
  for (std::size_t i = first; i < first + pieces * index_of(plan_.size.floors); ++i)
    for (std::size_t j = first; j < i; ++j) {
      const RoomPart &a = building_.parts[i], &b = building_.parts[j];
      const std::size_t count = a.solids_end - a.solids_begin;
      if (count != b.solids_end - b.solids_begin) continue;
      std::size_t equal = 0;
      for (std::size_t k = 0; k < count; ++k)
        equal +=
            building_.solids[a.solids_begin + k].half_m == building_.solids[b.solids_begin + k].half_m &&
            building_.materials[a.solids_begin + k].first == building_.materials[b.solids_begin + k].first;
      EXPECT_LT(equal, count) << i << " and " << j;
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, SimBuilding,
                         testing::Values(BuildingSize{2, 1, {}}, BuildingSize{2, 2, 2},
                                         BuildingSize{10, 2, {}}, BuildingSize{9, 1, {}},
                                         BuildingSize{31, 3, 4}, BuildingSize{26, 1, {}},
                                         BuildingSize{30, 1, 12}),
                         [](const auto& each) {
                           return std::to_string(each.param.rooms) + "RoomsOn" +
                                  std::to_string(each.param.floors) + "Alike" +
                                  std::to_string(each.param.alike.value_or(-2) + 2);
                         });

TEST(SimBuildingStairs, EachStepIsARiserHigherUpToTheNextFloor) {
  const BuildingPlan plan = plan_building(1, {6, 3, {}});
  const Room building = make_building(plan, 0);
  ASSERT_EQ(plan.stairs.size(), 2U);
  for (const PlannedStairs& stairs : plan.stairs)
    for (int floor = 0; floor < 2; ++floor)
      for (int step = 0; step <= 2 * kRisersPerFlight; ++step) {
        // The middles of the treads, up one flight and back up the other.
        const bool is_return = step > kRisersPerFlight;
        const int of_flight = is_return ? step - kRisersPerFlight : step;
        const double along_m = kLanding_m + (of_flight - 0.5) * kTread_m;
        const double x_m = is_return ? kStairwellLength_m - along_m : along_m;
        const double y_m = (is_return ? 0.5 : -0.5) * (kFlightWidth_m + kFlightGap_m);
        const double wanted_m = floor_height_m(floor) + step * kStoreyHeight_m / (2 * kRisersPerFlight);
        const Vector3d eye = stairs.T_world_stairs * Vector3d(x_m, y_m, wanted_m + 1.0);
        const auto hit = cast_ray(building, eye, -Vector3d::UnitZ());
        ASSERT_TRUE(hit);
        EXPECT_NEAR(eye.z() - hit->range_m, wanted_m, 1e-9) << floor << ", " << step;
        EXPECT_GT(cast_ray(building, eye, Vector3d::UnitZ())->range_m, 1.1) << "headroom";
      }
}

TEST(SimBuildingPlan, IsDeterministicAndDependsOnTheSeed) {
  const BuildingSize size{24, 2, {}};
  const Room a = make_building(plan_building(5, size), 1), b = make_building(plan_building(5, size), 2);
  ASSERT_EQ(a.solids.size(), b.solids.size());
  for (std::size_t i = 0; i < a.solids.size(); ++i) {
    EXPECT_EQ(a.solids[i].T_world_solid.matrix(), b.solids[i].T_world_solid.matrix());
    EXPECT_EQ(a.materials[i].seed, b.materials[i].seed);
  }
  EXPECT_NE(plan_building(6, size).length_m, plan_building(5, size).length_m);
}

TEST(SimBuildingPlan, NoDoorIsCutByTheEndOfAPiece) {
  for (const BuildingSize& size : {BuildingSize{10, 2, {}}, BuildingSize{160, 2, {}},
                                   BuildingSize{1000, 2, {}}, BuildingSize{1000, 10, {}}})
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const BuildingPlan plan = plan_building(seed, size);
      std::set<int> doors;
      for (const CorridorPiece& piece : plan.pieces)
        for (const PieceOpening& opening : piece.openings) {
          if (opening.leads_to != LeadsTo::kRoom) continue;
          EXPECT_GT(opening.from_m, piece.interior_m.min().x() + 0.15);
          EXPECT_LT(opening.to_m, piece.interior_m.max().x() - 0.15);
          doors.insert(opening.number);
        }
      EXPECT_EQ(doors.size(), index_of(plan.first_of_floor[1]));
    }
}

TEST(SimBuildingPlan, SizesOutOfRangeAreRefusedInWords) {
  const auto message = [](const BuildingSize& size) -> std::string {
    try {
      plan_building(1, size);
      return "accepted";
    } catch (const Error& error) {
      return error.what();
    }
  };
  EXPECT_NE(message({1, 1, {}}).find("2 to 1000"), std::string::npos);
  EXPECT_NE(message({1001, 1, {}}).find("2 to 1000"), std::string::npos);
  EXPECT_NE(message({10, 0, {}}).find("1 to 10"), std::string::npos);
  EXPECT_NE(message({10, 11, {}}).find("1 to 10"), std::string::npos);
  EXPECT_NE(message({3, 4, {}}).find("at most the number of rooms, 3"), std::string::npos);
  EXPECT_NE(message({10, 2, 3}).find("even number, 0 to 10"), std::string::npos);
  EXPECT_NE(message({10, 2, 12}).find("even number, 0 to 10"), std::string::npos);
  EXPECT_NE(message({10, 2, -2}).find("even number"), std::string::npos);
  EXPECT_THROW(make_room(kBuildingRoom), Error);
}

TEST(SimBuildingPlan, AThousandRoomsAreBuilt) {
  const auto begin = std::chrono::steady_clock::now();
  const BuildingPlan plan = plan_building(1, {1000, 2, {}});
  const Room building = make_building(plan, 0);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  std::printf("1000 rooms: %.1f s, %zu solids, %zu parts, corridors of %.0f m\n", took.count(),
              building.solids.size(), building.parts.size(), plan.length_m);
  EXPECT_GT(building.solids.size(), 50'000U);
  std::size_t most = 0;
  for (std::size_t i = 0; i < building.parts.size(); i += 9) {
    const Vector3d middle = building.parts[i].bounds_world.center();
    std::size_t solids = 0;
    for (const int part : visible_parts(building, middle))
      solids += building.parts[index_of(part)].solids_end - building.parts[index_of(part)].solids_begin;
    most = std::max(most, solids);
  }
  std::printf("at most %zu solids are seen from the middle of a part\n", most);
  EXPECT_LT(most, building.solids.size() / 8);
}

}  // namespace
}  // namespace roomradar::sim_building_test
