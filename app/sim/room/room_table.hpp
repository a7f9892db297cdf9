// room_table.hpp: a dining room with a table, four chairs and objects on it.
#pragma once
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Makes a dining room with table, four chairs, objects on the table, cupboard, window and pictures.
Room make_table_room();

}  // namespace roomradar
