// rooms.hpp: one function per room of make_room().
#pragma once
#include <cstdint>

#include "app/sim/room/room.hpp"

namespace roomradar {

Room make_table_room();  ///< dining table with four chairs and objects on it, cupboard, window, pictures
Room make_shelf_room();  ///< book shelves, sofa and coffee table
Room make_board_room();  ///< a checkerboard on a stand in a bare room
Room make_wall_room();   ///< one big wall and almost nothing else
/// Random arrangement of furniture; deterministic in the seed.
Room make_random_room(std::uint64_t seed);

}  // namespace roomradar
