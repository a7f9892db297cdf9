// building_walk.cpp: chooses the rooms of each walk, so that walks overlap, and joins them.
#include "app/sim/building/building_walk.hpp"

#include <algorithm>
#include <cmath>

#include "app/sim/building/building_route.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

constexpr int kStairWalkEvery = 6;  ///< each sixth walk leads up the stairs

/// Returns the index of the first room of a walk in the order past all doors: walks have 3 and 4 rooms by
/// turns, and share one with the next walk.
int first_place(int walk) { return 2 * walk + walk / 2; }

/// Returns the room at a place of the way past all doors: odd floors are walked in the opposite direction.
int room_in_order(const BuildingPlan& plan, int place) {
  const auto above = std::upper_bound(plan.first_of_floor.begin(), plan.first_of_floor.end(), place);
  const auto floor = static_cast<std::size_t>(above - plan.first_of_floor.begin()) - 1;
  return floor % 2 == 0 ? place : plan.first_of_floor[floor] + plan.first_of_floor[floor + 1] - 1 - place;
}

int room_nearest(const BuildingPlan& plan, const PlannedStairs& stairs, int floor) {
  const double stairs_x_m = stairs.T_world_stairs.translation().x();
  const auto at = static_cast<std::size_t>(floor);
  int best = plan.first_of_floor[at];
  const auto distance_m = [&](int number) {
    const PlannedRoom& room = plan.rooms[static_cast<std::size_t>(number)];
    return std::abs(door_x_m(room) - stairs_x_m) + (room.corridor == stairs.corridor ? 0.0 : 1e3);
  };
  for (int i = best; i < plan.first_of_floor[at + 1]; ++i)
    if (distance_m(i) < distance_m(best)) best = i;
  return best;
}

bool is_stair_walk(const BuildingPlan& plan, int walk) {
  return plan.size.floors > 1 && walk % kStairWalkEvery == kStairWalkEvery - 1;
}

/// Walks round a block of rooms, or up and down the stairs, or along the corridor and back, and on over the
/// start.
void walk_ring(Route& route) {
  constexpr double kWanted_m = 200.0, kOverlap_m = 3.0, kEnd_m = 1.2;
  const BuildingPlan& plan = route.plan;
  const double start_x = 0.5 * plan.length_m, south_y = plan.corridor_y_m.front();
  if (plan.corridor_y_m.size() > 1) {
    std::size_t corridor = 1;
    const double west_x = cross_corridor_x_m(plan, false), east_x = cross_corridor_x_m(plan, true);
    const auto length_m = [&] { return 2.0 * (east_x - west_x + plan.corridor_y_m[corridor] - south_y); };
    while (length_m() < kWanted_m && corridor + 1 < plan.corridor_y_m.size()) ++corridor;
    const double north_y = plan.corridor_y_m[corridor];
    for (const Eigen::Vector2d& corner :
         {Eigen::Vector2d(start_x, south_y), Eigen::Vector2d(east_x, south_y),
          Eigen::Vector2d(east_x, north_y), Eigen::Vector2d(west_x, north_y),
          Eigen::Vector2d(west_x, south_y), Eigen::Vector2d(start_x + kOverlap_m, south_y)})
      route.line_to(corner, 0.0);
    return;
  }
  if (plan.size.floors > 1) {
    const CorridorPlace start{0, 0, start_x};
    const PlannedStairs &west = plan.stairs.front(), &east = plan.stairs.back();
    const CorridorPlace east_above = before_stairs(plan, east, 1), west_above = before_stairs(plan, west, 1);
    route.line_to({start_x, south_y}, 0.0);
    route.walk_to(start, before_stairs(plan, east, 0));
    route.take_stairs(east, 0, 1);
    route.walk_to(east_above, west_above);
    route.take_stairs(west, 1, 0);
    route.walk_to(before_stairs(plan, west, 0), {0, 0, start_x + kOverlap_m});
    return;
  }
  constexpr double kAside_m = 0.25;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(start_x, south_y - kAside_m),
        Eigen::Vector2d(plan.length_m - kEnd_m, south_y - kAside_m),
        Eigen::Vector2d(plan.length_m - kEnd_m, south_y + kAside_m),
        Eigen::Vector2d(kEnd_m, south_y + kAside_m), Eigen::Vector2d(kEnd_m, south_y - kAside_m),
        Eigen::Vector2d(start_x, south_y - kAside_m)})
    route.line_to(corner, 0.0);
}

}  // namespace

int covering_walks(const BuildingPlan& plan) {
  int walks = 1;  // without those by the stairs
  while (first_place(walks) < plan.size.rooms - 1) ++walks;
  return plan.size.floors > 1 ? walks + (walks - 1) / (kStairWalkEvery - 1) : walks;
}

std::vector<int> rooms_of_walk(const BuildingPlan& plan, int walk) {
  if (walk == kRingWalk) return {};
  const std::uint64_t seed = hash_of(plan.seed, 0x726f7574, static_cast<std::uint64_t>(walk));
  if (is_stair_walk(plan, walk)) {
    const int turn = walk / kStairWalkEvery;
    const int by = turn % static_cast<int>(plan.stairs.size());
    const int floor = turn / static_cast<int>(plan.stairs.size()) % (plan.size.floors - 1);
    const PlannedStairs& stairs = plan.stairs[static_cast<std::size_t>(by)];
    return {room_nearest(plan, stairs, floor), room_nearest(plan, stairs, floor + 1)};
  }
  const int number = plan.size.floors > 1 ? walk - (walk + 1) / kStairWalkEvery : walk;
  const int last = plan.size.rooms - 1;
  int begin = first_place(number), end = std::min(first_place(number + 1), last);
  if (begin >= last) {
    CounterRandom random(seed, 0);
    begin = static_cast<int>(random.uniform() * last);
    end = std::min(begin + 1 + static_cast<int>(3.0 * random.uniform()), last);
  }
  std::vector<int> rooms;
  for (int place = begin; place <= end; ++place) rooms.push_back(room_in_order(plan, place));
  return rooms;
}

std::vector<WalkPoint> plan_walk(const BuildingPlan& plan, int walk) {
  Route route{plan};
  if (walk == kRingWalk) {
    walk_ring(route);
    return timed(route, kWalkStep_s);
  }
  const std::vector<int> rooms = rooms_of_walk(plan, walk);
  const PlannedRoom* before = nullptr;
  for (std::size_t i = 0; i < rooms.size(); ++i) {
    const PlannedRoom& room = plan.rooms[static_cast<std::size_t>(rooms[i])];
    if (before != nullptr) {
      const CorridorPlace from = before_door(*before);
      route.line_to({from.x_m, plan.corridor_y_m[static_cast<std::size_t>(from.corridor)]},
                    floor_height_m(from.floor));
      route.walk_to(from, before_door(room));
    }
    const bool is_left =
        hash_of(plan.seed, static_cast<std::uint64_t>(walk), static_cast<std::uint64_t>(rooms[i])) % 2 == 0;
    // Straight in, through the door's middle.
    route.round(room, is_left, i + 1 < rooms.size());
    before = &room;
  }
  return timed(route, kWalkStep_s);
}

}  // namespace roomradar
