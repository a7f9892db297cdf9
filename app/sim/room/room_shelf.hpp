// room_shelf.hpp: a living room with book shelves.
#pragma once
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Makes a living room with book shelves, sofa and coffee table.
Room make_shelf_room();

}  // namespace roomradar
