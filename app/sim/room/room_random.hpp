// room_random.hpp: a room of random size and furniture.
#pragma once
#include <cstdint>

#include "app/sim/room/room.hpp"

namespace roomradar {

/// Makes a room with a random arrangement of furniture, determined by the seed.
Room make_random_room(std::uint64_t seed);

}  // namespace roomradar
