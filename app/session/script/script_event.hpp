// script_event.hpp: one event of a run: its time, and its action on a virtual object or the session.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "app/objects/object_file.hpp"
#include "app/physics/body_material.hpp"
#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

/// Command that selects the next frame, or the behaviour after the last one.
enum class CameraPlay {
  kHold,    ///< the same frame again in each step, while time continues
  kGo,      ///< the source's next frame; ends kHold
  kRewind,  ///< the source's first frame, if held after the next kGo; a live device throws Error
  kLoop,    ///< from now on, the source's first frame follows its last frame
  kStay,    ///< from now on, the source's last frame is repeated at the end
  /// The source's next frame. Its time is set to 1/30 s after the previous frame's, since a device's clock
  /// continues during a pause.
  kResume,
};

inline constexpr double kMaxTurn_deg = 3600.0;  ///< max angle of one TurnObject, per axis

// Actions. Positions, velocities and rotations are in the world frame (+z up). `name` is the object's name.

/// Loads an object's mesh. The object is outside the room until another action puts it there.
struct AddObject {
  std::string name{};
  /// In a script, a mesh file is relative to the script's folder. ModelOrigin::kAsInFile is only for
  /// replaying sessions recorded before kNear was introduced.
  ObjectSource source{};
  BodyMaterial material{};  ///< an unset value is the default
  friend bool operator==(const AddObject&, const AddObject&) = default;
};

/// Puts an object at a position, with zero velocity.
struct PlaceObject {
  std::string name{};
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< m, object's origin
  /// Orientation as yaw, pitch and roll; see script.hpp. Unset: unchanged.
  std::optional<Eigen::Vector3d> turned_deg{};
  friend bool operator==(const PlaceObject&, const PlaceObject&) = default;
};

/// Lets an object fall from above a point, or from above a level surface in view.
struct DropObject {
  std::string name{};
  /// m. x and y of the object's origin, and the height z above which the object is dropped. Unset: the object
  /// is dropped above a level surface in view.
  std::optional<Eigen::Vector3d> position_world{};
  /// m. Used without position_world. Set: the drop is above the free level place nearest to near_world, at
  /// most 25 cm away; without such a place, it is cancelled with a notice. Unset: it is above the free level
  /// place nearest to the image centre, and waits for a later frame if there is none.
  std::optional<Eigen::Vector3d> near_world{};
  /// Initial height of the object's lowest vertex above the position or surface. Without position_world, it
  /// is reduced to 5 cm if the object would not stay otherwise.
  double height_m = 0.3;
  /// Orientation as yaw, pitch and roll; see script.hpp. Unset: unchanged.
  std::optional<Eigen::Vector3d> turned_deg{};
  friend bool operator==(const DropObject&, const DropObject&) = default;
};

/// Puts an object at a position, with a velocity.
struct ThrowObject {
  std::string name{};
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();                ///< m, object's origin
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();            ///< of the centre of mass
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();  ///< right-handed
  /// Orientation as yaw, pitch and roll; see script.hpp. Unset: unchanged.
  std::optional<Eigen::Vector3d> turned_deg{};
  friend bool operator==(const ThrowObject&, const ThrowObject&) = default;
};

/// Changes an object's mass, density, friction or restitution.
struct ChangeMaterial {
  std::string name{};
  BodyMaterial material{};  ///< an unset value is unchanged
  friend bool operator==(const ChangeMaterial&, const ChangeMaterial&) = default;
};

/// Takes an object out of the room.
struct RemoveObject {
  std::string name{};
  friend bool operator==(const RemoveObject&, const RemoveObject&) = default;
};

/// Rotates an object about its centre until the first contact.
struct TurnObject {
  std::string name{};
  Eigen::Vector3d turn_world_deg = Eigen::Vector3d::Zero();  ///< rotation vector, axis times angle
  friend bool operator==(const TurnObject&, const TurnObject&) = default;
};

/// Moves an object towards a position and holds it there until ReleaseObject. Obstacles stop it. An object
/// outside the room is put at the position.
struct CarryObject {
  std::string name{};
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();  ///< m, object's origin
  friend bool operator==(const CarryObject&, const CarryObject&) = default;
};

/// Lets go of a carried object, with a velocity.
struct ReleaseObject {
  std::string name{};
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< of the centre of mass
  friend bool operator==(const ReleaseObject&, const ReleaseObject&) = default;
};

/// Changes which surfaces can be touched.
struct SetSurfaces {
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  friend bool operator==(const SetSurfaces&, const SetSurfaces&) = default;
};

/// Makes unknown space free or solid.
struct SetUnknown {
  bool is_solid = false;
  friend bool operator==(const SetUnknown&, const SetUnknown&) = default;
};

/// Changes the radar's mode and resolution.
struct SetRadar {
  RadarConfig radar{};
  friend bool operator==(const SetRadar&, const SetRadar&) = default;
};

/// Changes quality settings.
struct SetQuality {
  RunQuality quality{};
  FramePart from = FramePart::kLocate;  ///< first processing stage of the frame that uses `quality`
  friend bool operator==(const SetQuality&, const SetQuality&) = default;
};

/// Changes which frame of the source is next.
struct PlayCamera {
  CameraPlay play = CameraPlay::kGo;
  friend bool operator==(const PlayCamera&, const PlayCamera&) = default;
};

/// Adds stationary objects in view to the session's copy of the map, and removes vanished objects from the
/// copy. The request expires after 1 s.
struct CommitChanges {
  friend bool operator==(const CommitChanges&, const CommitChanges&) = default;
};

/// Ends the run before this frame.
struct Quit {
  friend bool operator==(const Quit&, const Quit&) = default;
};

using Action = std::variant<AddObject, PlaceObject, DropObject, ThrowObject, ChangeMaterial, RemoveObject,
                            TurnObject, CarryObject, ReleaseObject, SetSurfaces, SetUnknown, SetRadar,
                            SetQuality, PlayCamera, CommitChanges, Quit>;

/// Returns the name of the action's object; empty for actions without an object.
std::string object_of(const Action& action);

/// One line of a script (script.hpp): an action, and when it is due.
struct ScriptEvent {
  Action action{};
  /// Index, from 0, of the run's frame before which the event is due. Alternative to time_s.
  std::optional<std::int64_t> frame{};
  /// The event is due before the first frame at or after this time of the run.
  std::optional<double> time_s{};
  int line = 0;  ///< 1-based line number in the file; 0: not from a file
};

/// Returns true if an event is due before a frame with this index and time in the run.
bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s);

}  // namespace roomradar
