// room_random.hpp: a room of random size and furniture, and a flat of such rooms.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "app/sim/room/furniture.hpp"
#include "app/sim/room/room.hpp"

namespace roomradar {

/// Properties of a random room that are not drawn at random.
struct RandomRoomShape {
  std::optional<Eigen::Vector2d> half_m;  ///< half the size of the interior along x and y; unset: random
  std::vector<Doorway> doorways;          ///< as in add_shell()
  /// Share of the pieces of furniture that stand elsewhere than they do at 0, with what is on them, 0 to 1.
  double moved = 0.0;
};

/// Makes a room with a random arrangement of furniture, determined by the seed. The room's middle is at x = y
/// = 0. The floor in front of doorways is free.
Room make_random_room(std::uint64_t seed, const RandomRoomShape& shape = {});

/// Makes random rooms in a ring, with a doorway between each pair of neighbours. The walk goes along most of
/// an ellipse in each room, facing its middle, and through the doorways.
Room make_flat(std::uint64_t seed);

}  // namespace roomradar
