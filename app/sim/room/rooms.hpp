// rooms.hpp: the rooms that make_room knows, one function each.
#pragma once
#include <cstdint>

#include "app/sim/room/room.hpp"

namespace roomradar {

Room make_table_room();  ///< a dining table with four chairs and things on it, cupboard, window, pictures
Room make_shelf_room();  ///< book shelves, sofa and coffee table
Room make_board_room();  ///< a checkerboard on a stand in a bare room
Room make_wall_room();   ///< one big wall and next to nothing else
/// A drawn arrangement of furniture; the same for the same seed.
Room make_random_room(std::uint64_t seed);

}  // namespace roomradar
