// building_route.hpp: builds a camera route through a building from straight segments, loops through rooms,
// and stairs.
#pragma once
#include <vector>

#include "app/sim/building/building_plan.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

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

/// Returns the corridor position in front of a room's door.
CorridorPlace before_door(const PlannedRoom& room);
/// Returns the corridor position in front of a stairwell's door.
CorridorPlace before_stairs(const BuildingPlan& plan, const PlannedStairs& stairs, int floor);

/// Returns the points of the route at equal time steps. Positions are smoothed over about 0.7 m, view
/// directions over 3 m. The speed is at most 0.42 m/s, and less where the view would turn by more than 24
/// degrees/s.
std::vector<WalkPoint> timed(const Route& route, double step_s);

}  // namespace roomradar
