// mapped_room.hpp: simulated rooms, each with a map from a simulated prescan.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/evaluation/fallthrough/policies.hpp"
#include "app/objects/shape.hpp"
#include "app/session/frame_scene.hpp"
#include "app/sim/scenarios/scenarios.hpp"

namespace roomradar {

/// Name and seed of a simulated room. The rooms `table`, `shelf` and `wall` have seed 1. Each `random` room
/// has its own seed.
struct RoomChoice {
  std::string name;
  std::uint64_t seed = 1;
};
/// Returns the rooms of room_names(), followed by random_rooms random rooms.
std::vector<RoomChoice> choose_rooms(int random_rooms);

struct RoomScan {
  double resolution_m = 0.01;
  int every = 3;       ///< every n-th of the prescan's 720 frames is fused
  int width_px = 640;  ///< width of the 4:3 depth images
  std::string maps;    ///< folder in which maps are stored for reuse; empty: none
};

/// A room and its map.
struct ScannedRoom {
  std::string title;  ///< such as "table" or "random 3"
  ScenarioRoom simulated;
  Mesh mesh_world;
  Mesh unknown_world;  ///< frontier of unknown space
};
/// Simulates a prescan of the room with noisy depth at known poses, fuses the frames and extracts the
/// surface. Loads the room's map instead if scan.maps contains one from this program version and the same
/// settings.
/// @param progress  called after each frame, possibly from several threads concurrently
/// @throws Error if no surface was found, or a stored map is damaged or belongs to another source
ScannedRoom scan_room(const RoomChoice& choice, const RoomScan& scan, const std::function<void()>& progress);

/// A scanned room in GPU memory, with one FrameScene per policy.
struct MappedRoom {
  ScannedRoom scanned;
  Shape shape;
  TriangleTree unknown;
  std::vector<std::unique_ptr<FrameScene>> scenes;  ///< one per entry of kFallthroughPolicies

  MappedRoom(GlContext& context, ScannedRoom room);
};

/// Room of a run's scenario, and the scenario's number in that room. Successive scenarios are assigned to the
/// rooms in rotation. The number in the room determines occluder, motion and shape, so all combinations occur
/// in each room.
struct ScenarioTurn {
  std::size_t room = 0;     ///< index of the room
  std::int64_t number = 0;  ///< number of the scenario in that room
};
/// Returns room and number in the room of the run's scenario `number`.
inline ScenarioTurn turn_of(std::int64_t number, std::size_t rooms) {
  const auto count = static_cast<std::int64_t>(rooms);
  return {static_cast<std::size_t>(number % count), number / count};
}

/// Scans the rooms, up to `threads` of them concurrently, and shows progress on stderr.
std::vector<std::unique_ptr<MappedRoom>> map_rooms(GlContext& context, const std::vector<RoomChoice>& rooms,
                                                   const RoomScan& scan, int threads);

}  // namespace roomradar
