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

/// Selects a room: `table`, `shelf`, `wall` with seed 1, or `random` with its own seed.
struct RoomChoice {
  std::string name;
  std::uint64_t seed = 1;
};
/// Returns the furnished rooms, followed by this many random ones.
std::vector<RoomChoice> choose_rooms(int random_rooms);

struct RoomScan {
  double resolution_m = 0.01;
  int every = 3;       ///< fuse only every n-th of the walk's 720 frames
  int width_px = 640;  ///< width of the depth images, 4:3
  std::string maps;    ///< folder in which maps are stored and reused; empty: none
};

/// A room and its map.
struct ScannedRoom {
  std::string title;  ///< "table", "random 3"
  ScenarioRoom simulated;
  Mesh mesh_world;
  Mesh unknown_world;  ///< border of unknown space
};
/// Walks round the room with its noisy depth camera at known poses, fuses the frames and extracts the
/// surface. If an earlier run stored this map, loads it instead.
/// @param progress  called after each frame, possibly from several threads at once
/// Throws Error if the room shows no surface or a stored map is damaged.
ScannedRoom scan_room(const RoomChoice& choice, const RoomScan& scan, const std::function<void()>& progress);

/// A scanned room in the renderer's memory, with a scene per policy.
struct MappedRoom {
  ScannedRoom scanned;
  Shape shape;
  TriangleTree unknown;
  std::vector<std::unique_ptr<FrameScene>> scenes;  ///< one per policy

  MappedRoom(GlContext& context, ScannedRoom room);
};

/// Assignment of a run's scenario to a room. Rooms alternate, and each room numbers its own scenarios. Kinds
/// of occluder, motion and shape alternate by this number; with the run's number, a room would get only some
/// of them.
struct ScenarioTurn {
  std::size_t room = 0;     ///< index among the rooms
  std::int64_t number = 0;  ///< number of the scenario in that room
};
/// Returns the room and number of the run's scenario `number`.
inline ScenarioTurn turn_of(std::int64_t number, std::size_t rooms) {
  const auto count = static_cast<std::int64_t>(rooms);
  return {static_cast<std::size_t>(number % count), number / count};
}

/// Scans the rooms, up to `threads` at a time, and shows progress on stderr.
std::vector<std::unique_ptr<MappedRoom>> map_rooms(GlContext& context, const std::vector<RoomChoice>& rooms,
                                                   const RoomScan& scan, int threads);

}  // namespace roomradar
