// player.hpp: converts the user's commands in the displayed picture into script events.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/session/script/script.hpp"
#include "app/session/session.hpp"
#include "app/window/link/ui_channel.hpp"
#include "radar/exact/ray_hit.hpp"

namespace roomradar {

/// Surfaces visible at a pixel of the session's picture.
struct Pointed {
  std::optional<MeshHit> surface;  ///< nearest point of room or dynamic foreground on the pixel's ray
  std::optional<MeshHit> object;   ///< nearest point of a virtual object on the ray, if in front of `surface`
  std::string name;                ///< name of the virtual object
};
/// Returns the surfaces at a pixel. Both points are unset if the camera was not localised.
Pointed pointed_at(const Session& session, const Eigen::Vector2d& pixel);

/// Returns the rotation vector (world axes, degrees) for a mouse drag. The object's front follows the mouse.
/// Sideways drags rotate about the vertical, or about the picture's up axis if the camera looks almost
/// vertically. Drags up and down rotate about the picture's right axis.
/// @param R_world_view  camera axes: x right, y down, z forward
/// @param way_px        motion of the mouse, x right, y down
Eigen::Vector3d turn_of_drag_world_deg(const Eigen::Matrix3d& R_world_view, const Eigen::Vector2d& way_px);

/// Remembers the chosen object and the object grabbed with the mouse.
class Player {
 public:
  /// Returns the commands' events, without frame numbers, in order of execution before the next frame. If an
  /// object is carried and released in the same call, its release is returned by the next call.
  std::vector<ScriptEvent> events_of(std::span<const UserCommand> commands, const Session& session);

  [[nodiscard]] const std::string& chosen() const { return chosen_; }
  [[nodiscard]] bool is_grabbed() const { return grabbed_.has_value(); }
  /// Returns the reason why a command of the last events_of() had no effect; empty if there was none.
  [[nodiscard]] const std::string& complaint() const { return complaint_; }

 private:
  struct Grabbed {
    std::string name;
    double distance_m = 0.0;  ///< distance of the grabbed point along its ray
    /// Centre of the object's bounding box minus the grabbed point, world axes.
    Eigen::Vector3d middle_from_point = Eigen::Vector3d::Zero();
    bool is_carried = false;
  };
  /// The chosen object, and where it would be put at a pixel.
  struct Target {
    const VirtualObject* object = nullptr;                     ///< the chosen object
    Eigen::Vector3d point_world = Eigen::Vector3d::Zero();     ///< m, point of the surface at the pixel
    Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< m, origin if the centre is over that point
    bool is_on_object = false;  ///< the surface is that of another virtual object
  };
  std::string chosen_;
  std::optional<Grabbed> grabbed_;
  std::string complaint_;
  std::vector<ScriptEvent> held_back_;  ///< events that the next call of events_of() returns

  void choose_if_none(const Session& session);
  void add(const AddNew& object, const Session& session, std::vector<ScriptEvent>& events);
  /// Returns the target at a pixel; unset, with a complaint, if there is no surface or no object is chosen.
  std::optional<Target> target_at(const Eigen::Vector2d& pixel, const Session& session);
  void drop_chosen(const Eigen::Vector2d& pixel, double height_m, const Session& session,
                   std::vector<ScriptEvent>& events);
  void place_chosen(const PlaceChosen& place, const Session& session, std::vector<ScriptEvent>& events);
  void throw_chosen(const ThrowChosen& command, const Session& session, std::vector<ScriptEvent>& events);
  void grab(const GrabObject& command, const Session& session);
  void drag(const DragGrabbed& command, const Session& session, std::vector<ScriptEvent>& events);
  void let_go(const LetGo& command, const Session& session, std::vector<ScriptEvent>& events);
};

}  // namespace roomradar
