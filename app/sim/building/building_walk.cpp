// building_walk.cpp: chooses the rooms of each walk, so that walks overlap, and joins them.
#include "app/sim/building/building_walk.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room.hpp"
#include "app/sim/solids/angles.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {
namespace {

/// A position on the centreline of a corridor.
struct CorridorPlace {
  int floor = 0, corridor = 0;
  double x_m = 0.0;
};

/// A route under construction, as points about 5 cm apart. The camera looks along the route unless stated
/// otherwise.
struct Route {
  const BuildingPlan& plan;
  std::vector<WalkPoint> points = {};

  /// Walks straight to a point. The view swings to both sides along lines of 3 m or more.
  void line_to(const Eigen::Vector2d& to_m, double floor_m);
  /// Walks along corridors and stairs to `to`. Precondition: the route's last point is near a corridor's
  /// centreline, at `from`.
  void walk_to(const CorridorPlace& from, const CorridorPlace& to);
  /// Walks a loop through a room, facing its middle. Precondition: the route's last point is in the corridor
  /// in front of the room's door, or the route is empty. An empty route begins inside the room.
  /// @param is_left  true: counter-clockwise
  /// @param leaves   true: ends inside the room in front of the door, facing the door
  void round(const PlannedRoom& room, bool is_left, bool leaves);
  /// Climbs or descends stairs between two floors, from and to the corridor in front of the stairwell.
  void take_stairs(const PlannedStairs& stairs, int from_floor, int to_floor);
};

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSample_m = 0.05;

/// Returns the angle, plus full turns, that is nearest to `near_rad`.
double unwrapped(double angle_rad, double near_rad) {
  return near_rad + std::remainder(angle_rad - near_rad, kFullTurn_rad);
}

/// Returns the length of a way between two corridor places of one floor, and whether it goes by the east end.
std::pair<double, bool> way_m(const BuildingPlan& plan, const CorridorPlace& a, const CorridorPlace& b) {
  if (a.corridor == b.corridor) return {std::abs(a.x_m - b.x_m), false};
  const auto by = [&](bool is_east) {
    const double x_m = cross_corridor_x_m(plan, is_east);
    return std::abs(a.x_m - x_m) + std::abs(b.x_m - x_m);
  };
  const bool is_east = by(true) < by(false);
  const double aside_m = std::abs(plan.corridor_y_m[static_cast<std::size_t>(a.corridor)] -
                                  plan.corridor_y_m[static_cast<std::size_t>(b.corridor)]);
  return {by(is_east) + aside_m, is_east};
}

/// Returns the corridor position in front of a room's door.
CorridorPlace before_door(const PlannedRoom& room) { return {room.floor, room.corridor, door_x_m(room)}; }

/// Returns the corridor position in front of a stairwell's door.
CorridorPlace before_stairs(const BuildingPlan& plan, const PlannedStairs& stairs, int floor) {
  const bool is_east = stairs.T_world_stairs.linear()(0, 0) > 0.0;
  const bool is_ring = plan.corridor_y_m.size() > 1;
  const double end_m = is_east ? plan.length_m - 1.0 : 1.0;
  return {floor, stairs.corridor, is_ring ? cross_corridor_x_m(plan, is_east) : end_m};
}

/// Walks from a place to another one of the same floor.
void walk_on_floor(Route& route, const CorridorPlace& from, const CorridorPlace& to) {
  const double floor_m = floor_height_m(to.floor);
  const auto middle_m = [&](int corridor) {
    return route.plan.corridor_y_m[static_cast<std::size_t>(corridor)];
  };
  if (from.corridor != to.corridor) {
    const double x_m = cross_corridor_x_m(route.plan, way_m(route.plan, from, to).second);
    route.line_to({x_m, middle_m(from.corridor)}, floor_m);
    route.line_to({x_m, middle_m(to.corridor)}, floor_m);
  }
  route.line_to({to.x_m, middle_m(to.corridor)}, floor_m);
}

/// Returns means of `values` over `half` samples to each side, fewer near the ends.
std::vector<double> smoothed(const std::vector<double>& values, std::size_t half) {
  std::vector<double> sums{0.0}, means;
  for (const double value : values) sums.push_back(sums.back() + value);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t reach = std::min({half, i, values.size() - 1 - i});
    means.push_back((sums[i + reach + 1] - sums[i - reach]) / static_cast<double>(2 * reach + 1));
  }
  return means;
}

void Route::line_to(const Vector2d& to_m, double floor_m) {
  if (points.empty()) {
    points.push_back({to_m, 0.0, floor_m});
    return;
  }
  const WalkPoint from = points.back();
  const Vector2d way = to_m - from.position_m;
  const double length_m = way.norm();
  if (length_m < 1e-6) return;
  const bool is_first = points.size() == 1;
  const double heading_rad = std::atan2(way.y(), way.x());
  const double yaw_rad = is_first ? heading_rad : unwrapped(heading_rad, from.yaw_rad);
  if (is_first) points.back().yaw_rad = yaw_rad;
  // Swings end at 0, so that lines join.
  constexpr double kSwing_rad = 0.75, kSwing_m = 7.0, kLeastSwung_m = 3.0;
  const double swings = length_m < kLeastSwung_m ? 0.0 : std::max(1.0, std::round(length_m / kSwing_m));
  const int count = std::max(1, static_cast<int>(std::ceil(length_m / kSample_m)));
  for (int i = 1; i <= count; ++i) {
    const double part = static_cast<double>(i) / count;
    const double swing_rad = swings == 0.0 ? 0.0 : kSwing_rad * std::sin(kFullTurn_rad * swings * part);
    points.push_back(
        {from.position_m + part * way, yaw_rad + swing_rad, from.floor_m + part * (floor_m - from.floor_m)});
  }
}

void Route::walk_to(const CorridorPlace& from, const CorridorPlace& to) {
  if (from.floor == to.floor) return walk_on_floor(*this, from, to);
  const PlannedStairs* best = nullptr;
  double shortest_m = std::numeric_limits<double>::infinity();
  for (const PlannedStairs& stairs : plan.stairs) {
    const double length_m = way_m(plan, from, before_stairs(plan, stairs, from.floor)).first +
                            way_m(plan, before_stairs(plan, stairs, to.floor), to).first;
    if (length_m >= shortest_m) continue;
    shortest_m = length_m;
    best = &stairs;
  }
  walk_on_floor(*this, from, before_stairs(plan, *best, from.floor));
  take_stairs(*best, from.floor, to.floor);
  walk_on_floor(*this, before_stairs(plan, *best, to.floor), to);
}

void Route::round(const PlannedRoom& room, bool is_left, bool leaves) {
  const Vector2d half = room.half_m - Vector2d(1.05, 1.0);  // as make_random_room() leaves free
  const double floor_m = floor_height_m(room.floor);
  const double out = room.is_north ? -1.0 : 1.0;  // towards the door, along y
  const double aside = room.door_aside_m / half.x();
  const double first_rad = std::atan2(out * std::sqrt(1.0 - aside * aside), aside);
  const auto at = [&](double angle_rad) -> Vector2d {
    return room.middle_m + half.cwiseProduct(Vector2d(std::cos(angle_rad), std::sin(angle_rad)));
  };
  line_to(at(first_rad), floor_m);
  if (points.size() == 1) points.back().yaw_rad = std::atan2(-out, 0.0);
  const double turn = is_left ? 1.0 : -1.0;
  const int count = static_cast<int>(std::ceil(kFullTurn_rad * half.maxCoeff() / kSample_m));
  double yaw_rad = points.back().yaw_rad, last_facing_rad = 0.0, out_rad = 0.0;
  bool turns_out = false;
  for (int i = 1; i <= count; ++i) {
    const double part = static_cast<double>(i) / count;
    const Vector2d p_m = at(first_rad + turn * kFullTurn_rad * part);
    const Vector2d facing = room.middle_m - p_m;
    if (!leaves || part < 0.75) {
      yaw_rad = unwrapped(std::atan2(facing.y(), facing.x()), yaw_rad);
      points.push_back({p_m, yaw_rad, floor_m});
      continue;
    }
    if (!turns_out) {  // on the last quarter, the view turns from the middle to the door
      turns_out = true;
      last_facing_rad = yaw_rad;
      out_rad = unwrapped(std::atan2(out, 0.0), yaw_rad);
    }
    points.push_back({p_m, last_facing_rad + (part - 0.75) / 0.25 * (out_rad - last_facing_rad), floor_m});
  }
}

void Route::take_stairs(const PlannedStairs& stairs, int from_floor, int to_floor) {
  constexpr double kBefore_m = 0.8, kAside_m = 0.5 * (kFlightWidth_m + kFlightGap_m),
                   kMiddle_m = 0.5 * kLanding_m;
  // The walked height rises evenly from half a tread before the flight to half a tread behind it.
  constexpr double kFoot_m = kLanding_m - 0.5 * kTread_m,
                   kHead_m = kStairwellLength_m - kLanding_m + 0.5 * kTread_m;
  std::vector<Vector3d> way;  // upwards, in the stairwell's frame
  const int low = std::min(from_floor, to_floor), high = std::max(from_floor, to_floor);
  way.emplace_back(-kBefore_m, 0.0, floor_height_m(low));
  way.emplace_back(kMiddle_m, 0.0, floor_height_m(low));
  for (int floor = low; floor < high; ++floor) {
    const double foot_m = floor_height_m(floor), half_m = foot_m + 0.5 * kStoreyHeight_m,
                 head_m = floor_height_m(floor + 1);
    way.emplace_back(kMiddle_m, -kAside_m, foot_m);
    way.emplace_back(kFoot_m, -kAside_m, foot_m);
    way.emplace_back(kHead_m, -kAside_m, half_m);
    way.emplace_back(kStairwellLength_m - kMiddle_m, -kAside_m, half_m);
    way.emplace_back(kStairwellLength_m - kMiddle_m, kAside_m, half_m);
    way.emplace_back(kHead_m, kAside_m, half_m);
    way.emplace_back(kFoot_m, kAside_m, head_m);
    way.emplace_back(kMiddle_m, kAside_m, head_m);
  }
  way.emplace_back(kMiddle_m, 0.0, floor_height_m(high));
  way.emplace_back(-kBefore_m, 0.0, floor_height_m(high));
  if (from_floor > to_floor) std::reverse(way.begin(), way.end());
  for (const Vector3d& p_stairs : way) {
    const Vector3d p_world = stairs.T_world_stairs * p_stairs;
    line_to(p_world.head<2>(), p_world.z());
  }
}

/// Returns the points of the route at equal time steps. Positions are smoothed over about 0.7 m, view
/// directions over 3 m. The speed is at most 0.42 m/s, and less where the view would turn by more than 24
/// degrees/s.
std::vector<WalkPoint> timed(const Route& route, double step_s) {
  constexpr double kSpeed_m_s = 0.42, kTurn_rad_s = 24.0 * std::numbers::pi / 180.0;
  constexpr std::size_t kHalf = 7, kHalfYaw = 32;  // samples: 0.35 m and 1.6 m
  std::vector<double> x, y, z, yaw;
  for (const WalkPoint& point : route.points) {
    x.push_back(point.position_m.x());
    y.push_back(point.position_m.y());
    z.push_back(point.floor_m);
    yaw.push_back(point.yaw_rad);
  }
  x = smoothed(x, kHalf);
  y = smoothed(y, kHalf);
  z = smoothed(z, kHalf);
  yaw = smoothed(yaw, kHalfYaw);
  std::vector<WalkPoint> points;
  double t_s = 0.0, next_s = 0.0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double length_m = std::hypot(x[i + 1] - x[i], y[i + 1] - y[i], z[i + 1] - z[i]);
    const double took_s =
        std::max({length_m / kSpeed_m_s, std::abs(yaw[i + 1] - yaw[i]) / kTurn_rad_s, 1e-9});
    for (; next_s <= t_s + took_s; next_s += step_s) {
      const double part = (next_s - t_s) / took_s;
      const auto between = [&](const std::vector<double>& of) { return of[i] + part * (of[i + 1] - of[i]); };
      points.push_back({{between(x), between(y)}, between(yaw), between(z)});
    }
    t_s += took_s;
  }
  return points;
}

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
