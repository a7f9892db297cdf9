// building.cpp: puts rooms, corridors and stairwells together, with the openings and lamps between them.
#include "app/sim/building/building.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include "app/sim/building/building_corridor.hpp"
#include "app/sim/building/building_stairs.hpp"
#include "app/sim/building/building_walk.hpp"
#include "app/sim/building/building_walls.hpp"
#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room_random.hpp"

namespace roomradar {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint32_t kLooks = 10'000;  ///< more than the materials of a room

/// Lamps of each part, beside Room::lamps.
using LampsOfParts = std::vector<std::vector<int>>;

void append(Room& building, Room&& part, const Eigen::AlignedBox3d& bounds_world, LampsOfParts& lamps) {
  RoomPart& entry = building.parts.emplace_back();
  entry.bounds_world = bounds_world;
  entry.solids_begin = building.solids.size();
  building.solids.insert(building.solids.end(), part.solids.begin(), part.solids.end());
  building.materials.insert(building.materials.end(), part.materials.begin(), part.materials.end());
  entry.solids_end = building.solids.size();
  std::vector<int>& own = lamps.emplace_back();
  for (const Lamp& lamp : part.lamps) {
    own.push_back(static_cast<int>(building.lamps.size()));
    building.lamps.push_back(lamp);
  }
}

Eigen::AlignedBox3d bounds_of_room(const PlannedRoom& room) {
  const Vector2d half = room.half_m + Vector2d::Constant(kShellThickness_m);
  const double floor_m = floor_height_m(room.floor);
  Eigen::AlignedBox3d bounds;
  bounds.extend(
      Vector3d(room.middle_m.x() - half.x(), room.middle_m.y() - half.y(), floor_m - kShellThickness_m));
  bounds.extend(Vector3d(room.middle_m.x() + half.x(), room.middle_m.y() + half.y(),
                         floor_m + kStoreyHeight_m - kShellThickness_m));
  return bounds;
}

Eigen::AlignedBox3d bounds_of_piece(const CorridorPiece& piece, int floor) {
  Eigen::AlignedBox2d plan = piece.interior_m;
  double beyond_m[4] = {kShellThickness_m, kShellThickness_m, kShellThickness_m,
                        kShellThickness_m};  // pieces without a wall between them touch
  for (const PieceOpening& opening : piece.openings)
    if (opening.leads_to == LeadsTo::kPiece) beyond_m[opening.side] = 0.0;
  plan.max() += Vector2d(beyond_m[3], beyond_m[0]);
  plan.min() -= Vector2d(beyond_m[2], beyond_m[1]);
  const double floor_m = floor_height_m(floor);
  return {Vector3d(plan.min().x(), plan.min().y(), floor_m - kShellThickness_m),
          Vector3d(plan.max().x(), plan.max().y(), floor_m + kStoreyHeight_m - kShellThickness_m)};
}

Eigen::AlignedBox3d bounds_of_stairs(const BuildingPlan& plan, const PlannedStairs& stairs) {
  constexpr double kHalfWidth_m = 0.5 * kStairwellWidth_m + kShellThickness_m;
  Eigen::AlignedBox3d bounds;
  bounds.extend(stairs.T_world_stairs * Vector3d(-kShellThickness_m, -kHalfWidth_m, -kShellThickness_m));
  bounds.extend(stairs.T_world_stairs * Vector3d(kStairwellLength_m + kShellThickness_m, kHalfWidth_m,
                                                 stairwell_top_m(plan) + kShellThickness_m));
  return bounds;
}

/// Adds an opening of a corridor's piece to the piece and to the part behind it.
void open(Room& building, const BuildingPlan& plan, int piece, const PieceOpening& opening, int floor) {
  const auto rooms = static_cast<int>(plan.rooms.size()), pieces = static_cast<int>(plan.pieces.size());
  const int here = rooms + floor * pieces + piece;
  int behind = rooms + floor * pieces + opening.number;
  if (opening.leads_to == LeadsTo::kRoom)
    behind = plan.first_of_floor[static_cast<std::size_t>(floor)] + opening.number;
  if (opening.leads_to == LeadsTo::kStairs) behind = rooms + plan.size.floors * pieces + opening.number;
  // In the plane between the two parts' walls.
  const Eigen::AlignedBox3d& bounds = building.parts[static_cast<std::size_t>(here)].bounds_world;
  PartOpening added;
  added.low_m = floor_height_m(floor);
  added.high_m = added.low_m + (opening.leads_to == LeadsTo::kPiece ? kCorridorHeight_m : kDoorwayHeight_m);
  added.part = behind;
  if (opening.side < 2) {
    const double y_m = opening.side == 0 ? bounds.max().y() : bounds.min().y();
    added.from_m = {opening.from_m, y_m};
    added.to_m = {opening.to_m, y_m};
  } else {
    const double x_m = opening.side == 3 ? bounds.max().x() : bounds.min().x();
    added.from_m = {x_m, opening.from_m};
    added.to_m = {x_m, opening.to_m};
  }
  building.parts[static_cast<std::size_t>(here)].openings.push_back(added);
  if (opening.leads_to == LeadsTo::kPiece) return;  // the piece behind has an opening of its own
  added.part = here;
  building.parts[static_cast<std::size_t>(behind)].openings.push_back(added);
}

/// Lights each part by the lamps of the parts within two openings of it, if they are near.
void assign_lamps(Room& building, const LampsOfParts& lamps) {
  constexpr double kFarthest_m = 10.0;
  for (std::size_t i = 0; i < building.parts.size(); ++i) {
    std::vector<int> parts{static_cast<int>(i)};
    for (std::size_t begin = 0, hop = 0; hop < 2; ++hop) {
      const std::size_t end = parts.size();
      for (; begin < end; ++begin)
        for (const PartOpening& opening : building.parts[static_cast<std::size_t>(parts[begin])].openings)
          if (std::find(parts.begin(), parts.end(), opening.part) == parts.end())
            parts.push_back(opening.part);
    }
    const Eigen::AlignedBox3d& bounds = building.parts[i].bounds_world;
    for (const int part : parts)
      for (const int lamp : lamps[static_cast<std::size_t>(part)])
        if (bounds.exteriorDistance(building.lamps[static_cast<std::size_t>(lamp)].position_world) <=
            kFarthest_m)
          building.parts[i].lamps.push_back(lamp);
  }
}

}  // namespace

Room make_building_room(const BuildingPlan& plan, int number) {
  const PlannedRoom& planned = plan.rooms[static_cast<std::size_t>(number)];
  const double aside_m = planned.door_aside_m;
  const Doorway door =
      planned.is_north ? Doorway{1, -aside_m, kDoorWidth_m} : Doorway{0, aside_m, kDoorWidth_m};
  Room room = make_random_room(planned.look_seed, {planned.half_m, {door}});
  const Vector3d shift(planned.middle_m.x(), planned.middle_m.y(), floor_height_m(planned.floor));
  for (Solid& solid : room.solids) solid.T_world_solid.pretranslate(shift);
  const int first_alike = planned.twin >= 0 ? std::min(planned.twin, number) : number;
  for (Material& material : room.materials) material.seed += kLooks * static_cast<std::uint32_t>(first_alike);
  for (Lamp& lamp : room.lamps) lamp.position_world += shift;
  for (Vector3d* const p :
       {&room.interior_min_world, &room.interior_max_world, &room.focus_world, &room.walk_centre_world,
        &room.ball_from_world, &room.ball_to_world, &room.person_from_world, &room.person_to_world})
    *p += shift;
  return room;
}

Room make_building(const BuildingPlan& plan, int walk, bool crate) {
  Room building;
  building.parts.reserve(plan.rooms.size() + plan.pieces.size() * static_cast<std::size_t>(plan.size.floors) +
                         plan.stairs.size());
  LampsOfParts lamps;
  for (std::size_t i = 0; i < plan.rooms.size(); ++i) {
    Room room = make_building_room(plan, static_cast<int>(i));
    if (i == 0) {
      if (crate) {
        room.solids.push_back(crate_in(room));
        room.materials.push_back(crate_material());
      }
      building.focus_world = room.focus_world;
      building.view_azimuth_rad = room.view_azimuth_rad;
      building.walk_half_m = room.walk_half_m;
      building.walk_centre_world = room.walk_centre_world;
      building.ball_from_world = room.ball_from_world;
      building.ball_to_world = room.ball_to_world;
      building.person_from_world = room.person_from_world;
      building.person_to_world = room.person_to_world;
    }
    append(building, std::move(room), bounds_of_room(plan.rooms[i]), lamps);
  }
  auto look = kLooks * static_cast<std::uint32_t>(plan.rooms.size());
  for (int floor = 0; floor < plan.size.floors; ++floor)
    for (std::size_t i = 0; i < plan.pieces.size(); ++i, look += kLooks) {
      Room piece;
      add_corridor_piece(piece, plan, static_cast<int>(i), floor, look);
      append(building, std::move(piece), bounds_of_piece(plan.pieces[i], floor), lamps);
    }
  for (const PlannedStairs& stairs : plan.stairs) {
    Room stairwell;
    add_stairwell(stairwell, plan, stairs, look);
    look += kLooks;
    append(building, std::move(stairwell), bounds_of_stairs(plan, stairs), lamps);
  }
  for (int floor = 0; floor < plan.size.floors; ++floor)
    for (std::size_t i = 0; i < plan.pieces.size(); ++i)
      for (const PieceOpening& opening : plan.pieces[i].openings)
        if (is_open_on(plan, opening, floor)) open(building, plan, static_cast<int>(i), opening, floor);
  assign_lamps(building, lamps);

  Eigen::AlignedBox3d bounds;
  for (const RoomPart& part : building.parts) bounds.extend(part.bounds_world);
  building.interior_min_world = bounds.min() + Vector3d::Constant(kShellThickness_m);
  building.interior_max_world = bounds.max() - Vector3d::Constant(kShellThickness_m);
  building.name = kBuildingRoom;
  building.walk = plan_walk(plan, walk);
  building.walk_step_s = kWalkStep_s;
  building.walk_centre_world.z() = kEyeHeight_m;
  building.tree = SolidTree(building.solids);
  return building;
}

}  // namespace roomradar
