// player.hpp: turns what a user wants into events of a script, by what the session shows now.
#pragma once
#include <Eigen/Geometry>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/physics/ray_hit.hpp"
#include "app/session/script.hpp"
#include "app/session/session.hpp"
#include "app/window/link/ui_channel.hpp"

namespace roomradar {

/// What is at a pixel of the session's picture.
struct Pointed {
  std::optional<MeshHit> surface;  ///< nearest of the room and of what moved
  std::optional<MeshHit> object;   ///< nearest of the virtual objects, if it is before that surface
  std::string name;                ///< of that object
};
/// Nothing where the camera was not located.
Pointed pointed_at(const Session& session, const Eigen::Vector2d& pixel);

/// How far to turn what a mouse is drawn over, so that the side of it that faces the camera goes with the
/// mouse. To the side it turns about the vertical, where the picture's up is anywhere near that; else, and up
/// and down, about the picture's own axes.
/// @param R_world_view  camera axes: x right, y down, z forward
/// @param way_px        of the mouse, x right, y down
Eigen::Vector3d turn_of_drag_world_deg(const Eigen::Matrix3d& R_world_view, const Eigen::Vector2d& way_px);

class Player {
 public:
  /// The events, without their frame, in the order in which they are to be applied before the next frame.
  /// Some may be of earlier wishes: of a carry and a release together, the release is held back for one
  /// frame.
  std::vector<ScriptEvent> events_of(std::span<const UserCommand> commands, const Session& session);

  [[nodiscard]] const std::string& chosen() const { return chosen_; }
  [[nodiscard]] bool is_grabbed() const { return grabbed_.has_value(); }
  /// Why the last wishes led to nothing; empty if they did.
  [[nodiscard]] const std::string& complaint() const { return complaint_; }

 private:
  struct Grabbed {
    std::string name;
    double distance_m = 0.0;                                      ///< of the grabbed point along its ray
    Eigen::Vector3d middle_from_point = Eigen::Vector3d::Zero();  ///< world axes
    bool is_carried = false;
  };
  std::string chosen_;
  std::optional<Grabbed> grabbed_;
  std::string complaint_;
  std::vector<ScriptEvent> held_back_;  ///< for the next call

  void choose_if_none(const Session& session);
  void add(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void drop_or_place(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void throw_chosen(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void grab(const UserCommand& command, const Session& session);
  void drag(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
  void let_go(const UserCommand& command, const Session& session, std::vector<ScriptEvent>& events);
};

}  // namespace roomradar
