// simulated_room.cpp: makes rooms and buildings, and selects their solids for one frame.
#include "app/sim/sensor/simulated_room.hpp"

#include <algorithm>
#include <cmath>

#include "app/sim/building/building.hpp"
#include "app/sim/room/room_parts.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {

Room room_of(const SimOptions& options) {
  const bool crate = options.crate == CrateKind::kStays;
  if (options.room != kBuildingRoom) return make_room(options.room, crate, options.seed, options.moved);
  return make_building(plan_building(options.seed, options.building), options.walk, crate);
}

std::int64_t frames_of(const SimOptions& options, const Room& room) {
  if (options.path != CameraPathKind::kScan || room.walk_step_s == 0.0)
    return options.frames == 0 ? SimOptions{}.frames : options.frames;
  const double walk_s = static_cast<double>(room.walk.size() - 1) * room.walk_step_s;
  const auto whole = static_cast<std::int64_t>(std::floor(walk_s * options.rate_hz)) + 1;
  return options.frames == 0 ? whole : std::min(options.frames, whole);
}

std::uint64_t path_seed(const SimOptions& options) {
  if (options.moved > 0.0) return hash_of(options.seed, 0x6d6f7665);
  if (options.room != kBuildingRoom) return options.seed;
  return hash_of(options.seed, 0x77616c6b, static_cast<std::uint64_t>(options.walk));
}

std::vector<std::size_t> visible_solids(const Room& room, const Eigen::Vector3d& eye_world,
                                        std::vector<Solid>& solids, std::vector<float>& infrared) {
  std::vector<std::size_t> indices;
  solids.clear();
  infrared.clear();
  const auto add_range = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      solids.push_back(room.solids[i]);
      infrared.push_back(room.materials[i].infrared);
      indices.push_back(i);
    }
  };
  if (room.parts.empty()) add_range(0, room.solids.size());
  for (const int part : visible_parts(room, eye_world)) {
    const RoomPart& seen = room.parts[static_cast<std::size_t>(part)];
    add_range(seen.solids_begin, seen.solids_end);
  }
  return indices;
}

}  // namespace roomradar
