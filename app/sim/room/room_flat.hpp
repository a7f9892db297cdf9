// room_flat.hpp: a flat of four rooms.
#pragma once
#include <cstdint>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Makes random rooms in a ring, with a doorway between each pair of neighbours. The walk goes along most of
/// an ellipse in each room, facing its middle, and through the doorways.
Room make_flat(std::uint64_t seed);

}  // namespace roomradar
