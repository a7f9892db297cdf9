// building_pieces.cpp: cuts corridors between doors, and joins the pieces.
#include "app/sim/building/building_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "app/sim/room/furniture.hpp"

namespace roomradar {
namespace {

using Eigen::Vector2d;

/// Returns where corridors are cut into pieces: 4 to 8 m apart, as far from doors as possible.
std::vector<double> cuts_of(const BuildingPlan& plan, int corridor) {
  std::vector<double> doors_m;
  for (const PlannedRoom& room : plan.rooms)
    if (room.floor == 0 && room.corridor == corridor) doors_m.push_back(door_x_m(room));
  std::vector<double> cuts{0.0};
  while (plan.length_m - cuts.back() > 8.0) {
    const double last_m = cuts.back();
    double best_m = 0.0, widest_m = -1.0;
    for (double x_m = last_m + 4.0; x_m <= std::min(last_m + 8.0, plan.length_m - 2.0); x_m += 0.125) {
      double free_m = 2.0;
      for (const double door_m : doors_m) free_m = std::min(free_m, std::abs(door_m - x_m));
      if (free_m <= widest_m) continue;
      best_m = x_m;
      widest_m = free_m;
    }
    cuts.push_back(best_m);
  }
  cuts.push_back(plan.length_m);
  return cuts;
}

/// Adds a piece from (low_x, low_y) to (high_x, high_y).
int add_piece(BuildingPlan& plan, double low_x, double low_y, double high_x, double high_y) {
  plan.pieces.push_back({{Vector2d(low_x, low_y), Vector2d(high_x, high_y)}, {}});
  return static_cast<int>(plan.pieces.size()) - 1;
}

/// Joins two pieces that share a side; b is north or east of a.
void join(BuildingPlan& plan, int a, int b, bool is_north) {
  CorridorPiece &first = plan.pieces[static_cast<std::size_t>(a)],
                &second = plan.pieces[static_cast<std::size_t>(b)];
  const int axis = is_north ? 0 : 1;
  const double from_m = first.interior_m.min()[axis], to_m = first.interior_m.max()[axis];
  first.openings.push_back({is_north ? 0U : 3U, from_m, to_m, LeadsTo::kPiece, b});
  second.openings.push_back({is_north ? 1U : 2U, from_m, to_m, LeadsTo::kPiece, a});
}

void add_room_doors(BuildingPlan& plan, int corridor, int piece) {
  CorridorPiece& to = plan.pieces[static_cast<std::size_t>(piece)];
  for (int i = 0; i < plan.first_of_floor[1]; ++i) {
    const PlannedRoom& room = plan.rooms[static_cast<std::size_t>(i)];
    if (room.corridor != corridor || door_x_m(room) < to.interior_m.min().x() ||
        door_x_m(room) >= to.interior_m.max().x())
      continue;
    to.openings.push_back({room.is_north ? 0U : 1U, door_x_m(room) - 0.5 * kDoorWidth_m,
                           door_x_m(room) + 0.5 * kDoorWidth_m, LeadsTo::kRoom, i});
  }
}

void add_stairs(BuildingPlan& plan, int corridor, int piece, bool is_east) {
  CorridorPiece& from = plan.pieces[static_cast<std::size_t>(piece)];
  const double y_m = plan.corridor_y_m[static_cast<std::size_t>(corridor)];
  from.openings.push_back({is_east ? 3U : 2U, y_m - 0.5 * kStairDoorWidth_m, y_m + 0.5 * kStairDoorWidth_m,
                           LeadsTo::kStairs, static_cast<int>(plan.stairs.size())});
  plan.stairs.push_back(
      {is_east ? standing_at(from.interior_m.max().x() + 2.0 * kShellThickness_m, y_m, 0.0)
               : standing_at(from.interior_m.min().x() - 2.0 * kShellThickness_m, y_m, 0.0, std::numbers::pi),
       corridor});
}

}  // namespace

void add_corridors(BuildingPlan& plan) {
  constexpr double kHalf_m = 0.5 * kCorridorWidth_m;
  const auto corridors = static_cast<int>(plan.corridor_y_m.size());
  const bool is_ring = corridors > 1;
  std::vector<int> west, east;  // the pieces at the ends of each corridor
  for (int corridor = 0; corridor < corridors; ++corridor) {
    const double y_m = plan.corridor_y_m[static_cast<std::size_t>(corridor)];
    std::vector<double> cuts = cuts_of(plan, corridor);
    if (is_ring) {
      cuts.insert(cuts.begin(), -kCorridorWidth_m);
      cuts.push_back(plan.length_m + kCorridorWidth_m);
    }
    int before = -1;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const int piece = add_piece(plan, cuts[i], y_m - kHalf_m, cuts[i + 1], y_m + kHalf_m);
      if (before < 0) west.push_back(piece);
      if (before >= 0) join(plan, before, piece, false);
      add_room_doors(plan, corridor, piece);
      before = piece;
    }
    east.push_back(before);
  }
  for (const std::vector<int>& ends : {west, east})
    for (std::size_t corridor = 0; corridor + 1 < ends.size(); ++corridor) {
      const Eigen::AlignedBox2d from = plan.pieces[static_cast<std::size_t>(ends[corridor])].interior_m;
      const double end_m = plan.corridor_y_m[corridor + 1] - kHalf_m,
                   middle_m = 0.5 * (from.max().y() + end_m);
      const int south = add_piece(plan, from.min().x(), from.max().y(), from.max().x(), middle_m);
      const int north = add_piece(plan, from.min().x(), middle_m, from.max().x(), end_m);
      join(plan, ends[corridor], south, true);
      join(plan, south, north, true);
      join(plan, north, ends[corridor + 1], true);
    }
  if (plan.size.floors == 1) return;
  // The second stairwell is where the walk past all doors ends.
  const int last = corridors - 1;
  const bool is_last_east = last % 2 == 0;
  add_stairs(plan, 0, west.front(), false);
  add_stairs(plan, last, is_last_east ? east.back() : west.back(), is_last_east);
}

}  // namespace roomradar
