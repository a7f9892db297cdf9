// room.cpp: makes rooms by name, with exact distances and rays in them.
#include "app/sim/room/room.hpp"

#include <algorithm>
#include <limits>

#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room_board.hpp"
#include "app/sim/room/room_flat.hpp"
#include "app/sim/room/room_random.hpp"
#include "app/sim/room/room_shelf.hpp"
#include "app/sim/room/room_table.hpp"
#include "app/sim/room/room_wall.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
const std::vector<std::string>& room_names() {
  static const std::vector<std::string> names{"table", "shelf", "wall"};
  return names;
}

void require_room(std::string_view name) {
  const std::vector<std::string>& furnished = room_names();
  if (name == kRandomRoom || name == kFlatRoom || name == kBuildingRoom || name == kBoardRoom ||
      std::find(furnished.begin(), furnished.end(), name) != furnished.end())
    return;
  std::string known;
  for (const std::string& one : furnished) known.append(one).append(", ");
  for (const std::string_view one : {kRandomRoom, kFlatRoom, kBuildingRoom}) known.append(one).append(", ");
  known.append(kBoardRoom);
  throw Error("no simulated room is called '" + std::string(name) + "'; known are: " + known);
}

Room make_room(std::string_view name, bool crate, std::uint64_t seed, double moved) {
  require_room(name);
  if (name == kBuildingRoom)
    throw Error("the simulated building is not a single room; use it as a source, sim:building");
  Room room;
  if (name == "table") {
    room = make_table_room();
  } else if (name == "shelf") {
    room = make_shelf_room();
  } else if (name == "wall") {
    room = make_wall_room();
  } else if (name == kRandomRoom) {
    room = make_random_room(seed, {.half_m = {}, .doorways = {}, .moved = moved});
  } else if (name == kFlatRoom) {
    room = make_flat(seed);
  } else {
    room = make_board_room();
  }
  if (crate) {
    room.solids.push_back(crate_in(room));
    room.materials.push_back(crate_material());
  }
  room.tree = SolidTree(room.solids);
  return room;
}

Solid crate_in(const Room& room) {
  const Eigen::Vector3d foot = 0.5 * (room.ball_from_world + room.ball_to_world);
  Solid crate = box({0, 0, 0.5 * kCrateSize_m.z()}, kCrateSize_m);
  crate.T_world_solid = standing_at(foot.x(), foot.y(), foot.z(), 0.3) * crate.T_world_solid;
  return crate;
}

Material crate_material() { return {Pattern::kPoster, {206, 120, 60}, {60, 44, 36}, 71, 0.6F}; }

double signed_distance_m(const Room& room, const Eigen::Vector3d& p_world) {
  return room.tree.signed_distance_m(room.solids, p_world);
}

std::optional<RayHit> cast_ray(const Room& room, const Eigen::Vector3d& origin_world,
                               const Eigen::Vector3d& direction_world) {
  return room.tree.cast(room.solids, origin_world, direction_world, std::numeric_limits<double>::infinity());
}

}  // namespace roomradar
