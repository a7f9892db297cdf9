// room_board.hpp: a checkerboard in a bare room.
#pragma once
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Makes a bare room with a checkerboard on a stand, for camera calibration.
Room make_board_room();

}  // namespace roomradar
