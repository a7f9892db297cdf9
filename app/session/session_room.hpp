// session_room.hpp: the static room of a session: its surface, and the border of unknown space.
#pragma once
#include <memory>

#include "app/objects/shape.hpp"
#include "app/objects/virtual_object.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/surface/unknown_surface.hpp"
#include "radar/geometry/triangle_tree.hpp"

namespace roomradar {

struct SessionRoom {
  Shape shape;                  ///< the map's mesh in the world, with all committed changes
  double lowest_known_m = 0.0;  ///< least height of the map's surface and observed space, in the world
  double extent_m = 0.0;        ///< longest side of the box around surface and observed space
  /// Null until unknown space is made solid for the first time.
  std::shared_ptr<const UnknownSurface> unknown{};
  TriangleTree unknown_tree{};
  bool unknown_is_solid = false;  ///< effective only with SurfacePolicy::kMap
};

/// Returns true if unknown space is solid and a corner or the centre of a triangle of the object is in it.
bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object);
/// The same, with the object at another pose.
bool is_in_solid_unknown(const SessionRoom& room, const VirtualObject& object,
                         const Eigen::Isometry3d& T_world_object);

/// Returns the least height of the map's surface and observed space, m in the world.
double lowest_known_m(const SavedMap& map);
/// Returns the longest side of the box around the map's surface and observed space, m.
double extent_m(const SavedMap& map);

}  // namespace roomradar
