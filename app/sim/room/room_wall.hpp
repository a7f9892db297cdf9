// room_wall.hpp: a nearly empty room with one big wall.
#pragma once
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Makes a room with one big wall and almost nothing else.
Room make_wall_room();

}  // namespace roomradar
