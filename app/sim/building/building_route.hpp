// building_route.hpp: builds a camera route through a building from straight lines and rounds through rooms.
#pragma once
#include <vector>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

/// A position on the middle line of a corridor.
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
  /// Walks along corridors and stairs to `to`. The route must end near a corridor's middle line.
  void walk_to(const CorridorPlace& from, const CorridorPlace& to);
  /// Walks round a room, facing its middle. The route must end at the room's door, or be empty. An empty
  /// route begins inside the room.
  /// @param is_left  true: counter-clockwise
  /// @param leaves   true: ends before the door, with a view towards it
  void round(const PlannedRoom& room, bool is_left, bool leaves);
  /// Climbs or descends stairs between two floors, from and to the corridor in front of the stairwell.
  void take_stairs(const PlannedStairs& stairs, int from_floor, int to_floor);
};

/// Returns the corridor position in front of a room's door.
CorridorPlace before_door(const PlannedRoom& room);
/// Returns the corridor position in front of a stairwell's door.
CorridorPlace before_stairs(const BuildingPlan& plan, const PlannedStairs& stairs, int floor);

/// Returns the points of the route at equal time steps. Positions are smoothed over about 0.7 m, view
/// directions over 3 m. The speed is at most 0.42 m/s, and less where the view would turn by more than 24
/// degrees/s.
std::vector<WalkPoint> timed(const Route& route, double step_s);

}  // namespace roomradar
