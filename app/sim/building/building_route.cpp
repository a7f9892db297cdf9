// building_route.cpp: samples lines, rounds and stairs, then smooths and times them.
#include "app/sim/building/building_route.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "app/sim/room/furniture.hpp"
#include "app/sim/solids/angles.hpp"

namespace roomradar {
namespace {

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

}  // namespace

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

CorridorPlace before_door(const PlannedRoom& room) { return {room.floor, room.corridor, door_x_m(room)}; }

CorridorPlace before_stairs(const BuildingPlan& plan, const PlannedStairs& stairs, int floor) {
  const bool is_east = stairs.T_world_stairs.linear()(0, 0) > 0.0;
  const bool is_ring = plan.corridor_y_m.size() > 1;
  const double end_m = is_east ? plan.length_m - 1.0 : 1.0;
  return {floor, stairs.corridor, is_ring ? cross_corridor_x_m(plan, is_east) : end_m};
}

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

}  // namespace roomradar
