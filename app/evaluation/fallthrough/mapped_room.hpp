// mapped_room.hpp: simulated rooms with the maps that a prescan made of them.
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

/// Which room: `table`, `shelf`, `wall` with seed 1, or `random` with a seed of its own.
struct RoomChoice {
  std::string name;
  std::uint64_t seed = 1;
};
/// The furnished rooms, and so many random ones.
std::vector<RoomChoice> choose_rooms(int random_rooms);

struct RoomScan {
  double resolution_m = 0.01;
  int every = 3;       ///< of the 720 frames round the room only every so many-th is fused
  int width_px = 640;  ///< of the depth images, 4:3
  std::string maps;    ///< folder to keep the maps in and to take them from; empty: none
};

/// A room and the map made of it.
struct ScannedRoom {
  std::string title;  ///< "table", "random 3"
  ScenarioRoom simulated;
  Mesh mesh_world;
  Mesh unknown_world;  ///< the border of what nobody has seen
};
/// Walks round the room with its noisy depth camera at known poses, fuses, and extracts the surface; or takes
/// the map of an earlier run that did the same.
/// @param progress  called after each frame, maybe from several threads at once
/// Throws Error if the room has no surface, or if there is a map that is broken.
ScannedRoom scan_room(const RoomChoice& choice, const RoomScan& scan, const std::function<void()>& progress);

/// The same on the renderer, with a scene for each policy.
struct MappedRoom {
  ScannedRoom scanned;
  Shape shape;
  TriangleTree unknown;
  std::vector<std::unique_ptr<FrameScene>> scenes;  ///< one a policy

  MappedRoom(GlContext& context, ScannedRoom room);
};

/// Rooms take turns, and each counts its own scenarios: kinds of occluder, motions and shapes take turns by
/// that count, and by the run's a room would meet some of them only.
struct ScenarioTurn {
  std::size_t room = 0;     ///< index among the rooms
  std::int64_t number = 0;  ///< of the scenario in that room
};
/// Of the run's scenario `number`.
inline ScenarioTurn turn_of(std::int64_t number, std::size_t rooms) {
  const auto count = static_cast<std::int64_t>(rooms);
  return {static_cast<std::size_t>(number % count), number / count};
}

/// Scans the rooms, `threads` at a time, and shows progress on stderr.
std::vector<std::unique_ptr<MappedRoom>> map_rooms(GlContext& context, const std::vector<RoomChoice>& rooms,
                                                   const RoomScan& scan, int threads);

}  // namespace roomradar
