// simulated_room.hpp: the room or building of a simulation, and the solids that may be visible from a camera.
#pragma once
#include <cstdint>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/sensor/sim_options.hpp"

namespace roomradar {

/// Makes the room that the options describe.
Room room_of(const SimOptions& options);

/// Returns the number of frames: SimOptions::frames, but at most those of an open walk. SimOptions::frames =
/// 0 means the whole walk, or the default number without a walk.
std::int64_t frames_of(const SimOptions& options, const Room& room);

/// Returns the seed of the camera's sway, the moving objects and the noise. It differs between the walks of a
/// building.
std::uint64_t path_seed(const SimOptions& options);

/// Selects all solids of a single room. In a building, selects the solids of the parts that may be visible
/// from eye_world.
/// @param solids    out: these solids
/// @param infrared  out: Material::infrared of each
/// @return their indices in Room::solids, ascending
std::vector<std::size_t> visible_solids(const Room& room, const Eigen::Vector3d& eye_world,
                                        std::vector<Solid>& solids, std::vector<float>& infrared);

}  // namespace roomradar
