// player.hpp: converts user commands into script events, based on the picture shown.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/physics/ray_hit.hpp"
#include "app/session/script/script.hpp"
#include "app/session/session.hpp"
#include "app/window/link/ui_channel.hpp"

namespace roomradar {

/// Surfaces at a pixel of the session's picture.
struct Pointed {
  std::optional<MeshHit> surface;  ///< nearest hit on room or dynamic foreground
  std::optional<MeshHit> object;   ///< nearest virtual object, if in front of that surface
  std::string name;                ///< name of that object
};
/// Returns the surfaces at a pixel; empty if the camera was not localised.
Pointed pointed_at(const Session& session, const Eigen::Vector2d& pixel);

/// Returns the rotation for a mouse drag that makes the object's front follow the mouse. Sideways drags
/// rotate about the vertical, or about the picture's up axis if the vertical is far from it. Drags up and
/// down rotate about the picture's right axis.
/// @param R_world_view  camera axes: x right, y down, z forward
/// @param way_px        path of the mouse, x right, y down
Eigen::Vector3d turn_of_drag_world_deg(const Eigen::Matrix3d& R_world_view, const Eigen::Vector2d& way_px);

class Player {
 public:
  /// Returns the events, without frame numbers, in the order to apply them before the next frame. If a carry
  /// and its release arrive together, the release is delayed by one frame, so the result may include events
  /// of earlier commands.
  std::vector<ScriptEvent> events_of(std::span<const UserCommand> commands, const Session& session);

  [[nodiscard]] const std::string& chosen() const { return chosen_; }
  [[nodiscard]] bool is_grabbed() const { return grabbed_.has_value(); }
  /// Returns the reason why the last commands had no effect; empty if they had one.
  [[nodiscard]] const std::string& complaint() const { return complaint_; }

 private:
  struct Grabbed {
    std::string name;
    double distance_m = 0.0;  ///< distance of the grabbed point along its ray
    Eigen::Vector3d middle_from_point = Eigen::Vector3d::Zero();  ///< object's middle minus grabbed point,
                                                                  ///< world axes
    bool is_carried = false;
  };
  std::string chosen_;
  std::optional<Grabbed> grabbed_;
  std::string complaint_;
  std::vector<ScriptEvent> held_back_;  ///< events delayed to the next call

  void choose_if_none(const Session& session);
  void add(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void drop_or_place(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void throw_chosen(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void grab(const UserCommand& command, const Session& session);
  void drag(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void let_go(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
};

}  // namespace roomradar
