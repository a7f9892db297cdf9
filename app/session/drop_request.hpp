// drop_request.hpp: an object to drop, and where it falls if it is dropped over a surface in view.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>

#include "app/objects/virtual_object.hpp"
#include "app/session/frame_scene.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

/// An object falls from above a point, or from above a level surface in view.
struct DropRequest {
  std::string name{};
  std::optional<Eigen::Vector3d> position_world{};  ///< unset: over a level surface in view
  double height_m = 0.3;  ///< height of its lowest point above the position or surface
  std::optional<Eigen::Matrix3d> R_world_object{};  ///< unset: the object keeps its orientation
};

/// A drop over a surface in view that has not found a surface.
struct WaitingDrop {
  DropRequest drop;
  std::int64_t try_at_frame = 0;  ///< earliest localised frame for the next search
};

/// Throws Error if the object is too large for any place in view.
void require_small_enough(const VirtualObject& object, const DropRequest& drop);

/// Searches a level surface of the room in view with space for the object; dynamic surfaces do not count.
/// @param R_world_object        orientation in which the object is dropped
/// @param camera                the depth camera
/// @param expected, foreground  of this frame
/// @returns position of the object's origin that puts its centre on the surface; nothing if no place is found
std::optional<Eigen::Vector3d> find_drop_position(
    const VirtualObject& object, const Eigen::Matrix3d& R_world_object, const Intrinsics& camera,
    const Eigen::Isometry3d& T_world_camera, const ExpectedView& expected, const FrameForeground& foreground);

}  // namespace roomradar
