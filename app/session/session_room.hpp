// session_room.hpp: the static room of a session, with its surface and the frontier of unknown space.
#pragma once
#include <future>
#include <memory>

#include "app/objects/shape.hpp"
#include "app/objects/virtual_object.hpp"
#include "app/session/map_updater.hpp"
#include "app/session/tiles/tile_window.hpp"
#include "mapping/localization/patch_matching.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

struct SessionRoom {
  Shape shape;                  ///< the map's mesh in the world, with all committed changes
  double lowest_known_m = 0.0;  ///< world z of the lowest point of the map's surface and observed space
  double extent_m = 0.0;        ///< longest side of the bounding box of surface and observed space
  /// Frontier of unknown space. Null until unknown space is made solid for the first time.
  std::shared_ptr<const UnknownSurface> unknown{};
  TriangleTree unknown_tree{};
  bool unknown_is_solid = false;  ///< effective only with SurfacePolicy::kMap
  /// Tiles of a building, whose surfaces and frontiers replace `shape` and `unknown`. Null in the map of a
  /// room.
  const TileWindow* tiles = nullptr;
};

/// What other threads compute from a map.
struct RoomPreparation {
  std::future<TriangleTree> tree;   ///< of the map's mesh
  std::future<PatchIndex> patches;  ///< of the map's keyframes; empty unless requested
};

/// Starts the threads. `map` must outlive the result.
/// @param will_search  true: the first frame searches the map, which needs `patches`
RoomPreparation prepare_room(const SavedMap& map, bool will_search);

/// Returns true if the surfaces near the object are loaded, which is always so in the map of a room. If not,
/// the object is not advanced unless it is carried.
bool is_loaded_round(const SessionRoom& room, const VirtualObject& object);

/// Sets the frontier of unknown space to the map's. Extracts the frontier if it was not saved.
void set_unknown(SessionRoom& room, const SavedMap& map);
/// Replaces the surface, and the frontier of unknown space if it is set, by those of a committed change.
void take_over(SessionRoom& room, ChangedRoom& changed);

/// Returns true if a position is in unknown space. Requires unknown space to be solid.
bool is_unknown_at(const SessionRoom& room, const Eigen::Vector3d& p_world);
/// Returns true if unknown space is solid and a vertex or triangle centroid of the object is in it.
bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object);
/// Returns is_in_solid_unknown() for the object at another pose.
bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object,
                         const Eigen::Isometry3d& T_world_object);

/// Sets lowest_known_m and extent_m to those of the map's surface and observed space.
void set_extent(SessionRoom& room, const SavedMap& map);

}  // namespace roomradar
