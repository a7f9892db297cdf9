// building_plan.cpp: places rooms in rows along corridors, and pairs look-alikes.
#include "app/sim/building/building_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "app/sim/room/furniture.hpp"
#include "mapping/types/system/counter_random.hpp"
#include "mapping/types/system/error.hpp"

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

/// Adds the pieces of the corridors, and the stairwells if there is more than one floor, to a plan that has
/// its rooms, BuildingPlan::corridor_y_m and BuildingPlan::length_m. Pieces are 4 to 8 m long, with their
/// boundaries between doors.
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

using Eigen::Vector2d;

constexpr int kLeastForRing = 12;     ///< rooms per floor from which on there are two corridors
constexpr int kMostPerCorridor = 40;  ///< keeps corridors below about 130 m
constexpr double kShells_m = 2.0 * kShellThickness_m;  ///< between two interiors
constexpr double kMostDepth_m = 5.6;
constexpr double kBetweenCorridors_m = kCorridorWidth_m + kShells_m + 2.0 * (kMostDepth_m + kShells_m) + 0.1;

int rooms_on(const BuildingSize& size, int floor) {
  return size.rooms / size.floors + (floor < size.rooms % size.floors ? 1 : 0);
}
int corridors_of(int rooms) {
  return rooms < kLeastForRing ? 1 : std::max(2, (rooms + kMostPerCorridor - 1) / kMostPerCorridor);
}
/// Returns the number of rooms along one side of one corridor.
int rooms_in_row(int rooms, int corridors, int corridor, bool is_north) {
  const int here = rooms / corridors + (corridor < rooms % corridors ? 1 : 0);
  return is_north ? here / 2 : here - here / 2;
}

/// A room of the lowest floor; upper floors repeat its position and size.
struct Slot {
  PlannedRoom room;
  int row = 0, column = 0, columns = 0;  ///< `columns`: of its row
};

/// Two rooms that may look alike.
struct Pair {
  std::size_t first = 0, second = 0;
};

/// Draws the size of a slot, the place of its door, and the gap after it.
void draw_size(std::uint64_t seed, Slot& slot, double& gap_m) {
  CounterRandom random(hash_of(seed, 0x706c616e), static_cast<std::uint64_t>(slot.row * 1000 + slot.column));
  slot.room.half_m.x() = 0.5 * random.uniform(4.8, 6.6);
  slot.room.half_m.y() = 0.5 * random.uniform(4.6, kMostDepth_m);
  slot.room.door_aside_m = 0.3 * slot.room.half_m.x() * random.uniform(-1.0, 1.0);
  gap_m = random.uniform(0.0, 0.5);
}

/// Returns the column whose size a column has: on the only floor, both halves of a row have the same sizes,
/// so that rooms in them can look alike.
int sized_as(const BuildingSize& size, int column, int columns) {
  const int half = columns / 2;
  return size.floors == 1 && column >= half && column < 2 * half ? column - half : column;
}

std::vector<Slot> place_slots(BuildingPlan& plan) {
  const int rooms = rooms_on(plan.size, 0), corridors = corridors_of(rooms);
  std::vector<Slot> slots;
  for (int corridor = 0; corridor < corridors; ++corridor) {
    plan.corridor_y_m.push_back(corridor * kBetweenCorridors_m);
    const auto begin = static_cast<std::ptrdiff_t>(slots.size());
    for (const bool is_north : {false, true}) {
      double x_m = kShells_m;
      const int columns = rooms_in_row(rooms, corridors, corridor, is_north);
      for (int column = 0; column < columns; ++column) {
        Slot slot;
        slot.row = 2 * corridor + (is_north ? 1 : 0);
        slot.column = sized_as(plan.size, column, columns);
        double gap_m = 0.0;
        draw_size(plan.seed, slot, gap_m);
        slot.column = column;
        slot.columns = columns;
        PlannedRoom& room = slot.room;
        room.corridor = corridor;
        room.is_north = is_north;
        const double side = is_north ? 1.0 : -1.0;
        room.middle_m = {
            x_m + room.half_m.x(),
            plan.corridor_y_m.back() + side * (0.5 * kCorridorWidth_m + kShells_m + room.half_m.y())};
        x_m += 2.0 * room.half_m.x() + kShells_m;
        plan.length_m = std::max(plan.length_m, x_m);
        x_m += gap_m;
        slots.push_back(slot);
      }
    }
    std::sort(slots.begin() + begin, slots.end(), [corridor](const Slot& a, const Slot& b) {
      return corridor % 2 == 0 ? door_x_m(a.room) < door_x_m(b.room) : door_x_m(a.room) > door_x_m(b.room);
    });
  }
  return slots;
}

/// Returns the pairs of rooms that can look alike: on floors 0 and 1, 2 and 3 and so on, or in one row.
std::vector<Pair> possible_pairs(const BuildingPlan& plan, const std::vector<Slot>& slots) {
  std::vector<Pair> pairs;
  if (plan.size.floors == 1) {
    for (std::size_t i = 0; i < slots.size(); ++i)
      for (std::size_t j = 0; j < slots.size(); ++j)
        if (slots[i].row == slots[j].row && slots[j].column - slots[i].column == slots[i].columns / 2 &&
            slots[i].column < slots[i].columns / 2)
          pairs.push_back({i, j});
    return pairs;
  }
  for (std::size_t floor = 0; floor + 1 < plan.first_of_floor.size() - 1; floor += 2) {
    const auto first = static_cast<std::size_t>(plan.first_of_floor[floor]),
               second = static_cast<std::size_t>(plan.first_of_floor[floor + 1]),
               end = static_cast<std::size_t>(plan.first_of_floor[floor + 2]);
    for (std::size_t i = 0; second + i < end; ++i) pairs.push_back({first + i, second + i});
  }
  return pairs;
}

void choose_twins(BuildingPlan& plan, std::vector<Pair> pairs) {
  const int default_alike = std::min(2 * (plan.size.rooms / 10), most_alike(plan.size));
  const auto count = static_cast<std::size_t>(plan.size.alike.value_or(default_alike) / 2);
  std::sort(pairs.begin(), pairs.end(), [&plan](const Pair& a, const Pair& b) {
    const auto order = [&plan](const Pair& pair) { return hash_of(plan.seed, 0x7477696e, pair.first); };
    return order(a) < order(b);
  });
  for (std::size_t i = 0; i < count; ++i) {
    PlannedRoom &first = plan.rooms[pairs[i].first], &second = plan.rooms[pairs[i].second];
    second.look_seed = first.look_seed;
    first.twin = static_cast<int>(pairs[i].second);
    second.twin = static_cast<int>(pairs[i].first);
  }
}

[[noreturn]] void refuse(const char* key, int value, const std::string& rule) {
  throw Error(std::string("sim: ") + key + " = '" + std::to_string(value) + "': must be " + rule);
}

}  // namespace

int most_alike(const BuildingSize& size) {
  int pairs = 0;
  if (size.floors == 1) {
    const int corridors = corridors_of(size.rooms);
    for (int corridor = 0; corridor < corridors; ++corridor)
      for (const bool is_north : {false, true})
        pairs += rooms_in_row(size.rooms, corridors, corridor, is_north) / 2;
  }
  for (int floor = 1; floor < size.floors; floor += 2) pairs += rooms_on(size, floor);
  return 2 * pairs;
}

void require_valid(const BuildingSize& size) {
  if (size.rooms < 2 || size.rooms > 1000) refuse("rooms", size.rooms, "a whole number, 2 to 1000");
  if (size.floors < 1 || size.floors > 10) refuse("floors", size.floors, "a whole number, 1 to 10");
  if (size.floors > size.rooms)
    refuse("floors", size.floors, "at most the number of rooms, " + std::to_string(size.rooms));
  if (size.alike && (*size.alike < 0 || *size.alike > most_alike(size) || *size.alike % 2 != 0))
    refuse("alike", *size.alike,
           "an even number, 0 to " + std::to_string(most_alike(size)) + " for this building");
}

BuildingPlan plan_building(std::uint64_t seed, const BuildingSize& size) {
  require_valid(size);
  BuildingPlan plan;
  plan.seed = seed;
  plan.size = size;
  const std::vector<Slot> slots = place_slots(plan);
  for (int floor = 0; floor < size.floors; ++floor) {
    plan.first_of_floor.push_back(static_cast<int>(plan.rooms.size()));
    for (int i = 0; i < rooms_on(size, floor); ++i) {
      PlannedRoom room = slots[static_cast<std::size_t>(i)].room;
      room.floor = floor;
      room.look_seed = hash_of(seed, 0x726f6f6d, plan.rooms.size());
      plan.rooms.push_back(room);
    }
  }
  plan.first_of_floor.push_back(size.rooms);
  choose_twins(plan, possible_pairs(plan, slots));
  add_corridors(plan);
  return plan;
}

double cross_corridor_x_m(const BuildingPlan& plan, bool is_east) {
  return is_east ? plan.length_m + 0.5 * kCorridorWidth_m : -0.5 * kCorridorWidth_m;
}

std::optional<BuildingPlace> place_at(const BuildingPlan& plan, const Eigen::Vector3d& p_world) {
  const double storey = std::floor(p_world.z() / kStoreyHeight_m);
  if (!(storey >= 0.0 && storey < plan.size.floors)) return std::nullopt;
  const auto floor = static_cast<int>(storey);
  const Vector2d p_m = p_world.head<2>();
  for (int i = plan.first_of_floor[static_cast<std::size_t>(floor)];
       i < plan.first_of_floor[static_cast<std::size_t>(floor) + 1]; ++i) {
    const PlannedRoom& room = plan.rooms[static_cast<std::size_t>(i)];
    if (((p_m - room.middle_m).cwiseAbs() - room.half_m).maxCoeff() <= 0.0) return BuildingPlace{floor, i};
  }
  for (const CorridorPiece& piece : plan.pieces)
    if (piece.interior_m.contains(p_m)) return BuildingPlace{floor, -1};
  for (const PlannedStairs& stairs : plan.stairs) {
    const Eigen::Vector3d p_stairs = stairs.T_world_stairs.inverse() * p_world;
    if (p_stairs.x() >= 0.0 && p_stairs.x() <= kStairwellLength_m &&
        std::abs(p_stairs.y()) <= 0.5 * kStairwellWidth_m)
      return BuildingPlace{floor, -1};
  }
  return std::nullopt;
}

}  // namespace roomradar
