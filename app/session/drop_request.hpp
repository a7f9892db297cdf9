// drop_request.hpp: requests to drop an object, and the search for a surface in view to drop it on.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/session_room.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"

namespace roomradar {

/// Drops an object from above a position, or from above a level surface in view.
struct DropRequest {
  std::string name{};
  std::optional<Eigen::Vector3d> position_world{};  ///< unset: over a level surface in view
  /// Without position_world: the surface nearest to this point, at most 25 cm away; unset: the surface
  /// nearest to the picture's centre.
  std::optional<Eigen::Vector3d> near_world{};
  double height_m = 0.3;  ///< height of the object's lowest point above the position or surface
  std::optional<Eigen::Matrix3d> R_world_object{};  ///< unset: the object keeps its orientation
};

/// A drop over a surface in view for which no surface has been found so far.
struct WaitingDrop {
  DropRequest drop;
  std::int64_t try_at_frame = 0;  ///< earliest localised frame for the next search
  /// Reason why the last search failed, as the end of a sentence; empty: no search so far.
  std::string why{};
};

/// Throws Error if the object is too large for any place in view.
void require_small_enough(const VirtualObject& object, const DropRequest& drop);

/// Surfaces of a frame, and the queries that check whether an object's fall is free.
struct DropScene {
  const SessionRoom& room;
  const std::vector<SceneTree>& surfaces;  ///< everything that the object can touch
  CyberRadar& radar;
};

/// Result of find_drop_position().
struct [[nodiscard]] DropPosition {
  std::optional<Eigen::Vector3d>
      position_world;  ///< position of the object's origin, with its centre on the surface
  std::string why;     ///< if there is no position: the end of a sentence
};

/// Searches for a level surface of the room in view on which the object can stand, with free space above.
/// Dynamic surfaces do not count.
/// @param camera                the depth camera
/// @param expected, foreground  of this frame
DropPosition find_drop_position(const VirtualObject& object, const DropRequest& drop,
                                const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                                const ExpectedView& expected, const FrameForeground& foreground,
                                const DropScene& scene);

}  // namespace roomradar
