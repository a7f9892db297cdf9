// drop_request.hpp: requests to drop an object, and the search for a visible surface to drop it on.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/objects/virtual_object.hpp"
#include "app/physics/physics_config.hpp"
#include "app/session/frame_scene.hpp"
#include "app/session/session_room.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/exact/cyber_radar.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/motion/proximity.hpp"

namespace roomradar {

/// Reduced height of a drop onto a surface in view, used if the object would topple or roll away when dropped
/// from the requested height.
inline constexpr double kGentleDrop_m = 0.05;

/// Request to drop an object from above a given position or from above a level surface in view.
struct DropRequest {
  std::string name{};
  std::optional<Eigen::Vector3d> position_world{};  ///< unset: above a level surface in view
  /// Used without position_world. Set: the search takes the free level place nearest to near_world, at most
  /// 25 cm away. Unset: the search takes the free level place nearest to the image centre.
  std::optional<Eigen::Vector3d> near_world{};
  /// Initial height of the object's lowest vertex above the position or surface. Without position_world, the
  /// height is reduced to kGentleDrop_m if the object would not stay otherwise.
  double height_m = 0.3;
  std::optional<Eigen::Matrix3d> R_world_object{};  ///< unset: the object keeps its orientation
};

/// A drop request without a position, for which no surface has been found so far.
struct WaitingDrop {
  DropRequest drop;
  std::int64_t try_at_frame = 0;  ///< the next search is in this localised frame or later
  /// Reason why the last search failed, as the end of a sentence. Empty: not searched so far.
  std::string why{};
};

/// Throws Error if the object's footprint (circle that it covers seen from above) has a radius above
/// kMostFootprint_m (1 m), the largest that the search for a surface supports.
void require_small_enough(const VirtualObject& object, const DropRequest& drop);

/// Surfaces of a frame, and the queries and physics that simulate an object's fall.
struct DropScene {
  const SessionRoom& room;
  const std::vector<SceneTree>& surfaces;  ///< all surfaces that the object can touch
  const PhysicsConfig& physics;
  CyberRadar& radar;
};

/// The frame in which find_drop_position() looks for a surface. Refers to its parts, which must outlive it.
struct DropView {
  const Intrinsics& camera;  ///< depth camera of the frame
  const Eigen::Isometry3d& T_world_camera;
  const ExpectedView& expected;
  const FrameForeground& foreground;
};

/// Result of find_drop_position().
struct [[nodiscard]] DropPosition {
  /// Position of the object's origin for which its centre is above the surface point; z is the surface's
  /// height. Unset: no surface was found.
  std::optional<Eigen::Vector3d> position_world;
  double height_m = 0.0;  ///< at most DropRequest::height_m
  /// End of a sentence: why no surface was found, or why the object may not stay or is dropped from a
  /// smaller height. Empty: the drop is as requested.
  std::string note;
};

/// Searches the view for a level surface of the static room on which the object can stand, onto which it can
/// fall freely and where it then stays. Dynamic surfaces count only if the scene has no static surface.
/// Simulates a fall from drop.height_m, and from kGentleDrop_m if the object does not stay, for at most 6
/// places. If the object stays in none of them, the first place is returned.
/// @param view  the current frame
DropPosition find_drop_position(const VirtualObject& object, const DropRequest& drop, const DropView& view,
                                const DropScene& scene);

}  // namespace roomradar
