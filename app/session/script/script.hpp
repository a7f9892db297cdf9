// script.hpp: reads the events file of `roomradar run --script FILE`, a list of timed actions.
#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

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

/// Puts an object exactly into a pose, at rest: it is not moved out of surfaces, and moves only once something
/// wakes it.
struct StandObject {
  std::string name{};
  Eigen::Vector3d position_world = Eigen::Vector3d::Zero();            ///< m, object's origin
  Eigen::Quaterniond R_world_object = Eigen::Quaterniond::Identity();  ///< unit
  friend bool operator==(const StandObject& a, const StandObject& b) {
    return a.name == b.name && a.position_world == b.position_world &&
           a.R_world_object.coeffs() == b.R_world_object.coeffs();
  }
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

using Action = std::variant<AddObject, PlaceObject, StandObject, DropObject, ThrowObject, ChangeMaterial, RemoveObject,
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

/// Events in the order of the file, which is the order of execution. An event is executed when it is due and
/// all events before it have been executed. All numbers are finite. Each name is added once, before its first
/// use.
struct Script {
  std::vector<ScriptEvent> events;
};

/// Returns true if an event of the script has this kind of action.
template <typename Kind>
bool has(const Script& script) {
  return std::any_of(script.events.begin(), script.events.end(),
                     [](const ScriptEvent& event) { return std::holds_alternative<Kind>(event.action); });
}

/// Treatment of a last line without a line end. kWhole reads the line as an event. kMayBeCut ignores the
/// line, since its writing may have been interrupted.
enum class LastLine { kWhole, kMayBeCut };

/// Reads an events file. One event per line, words separated by spaces or tabs, # begins a comment:
///
///     frame 0    add pot teapot size 0.2
///     frame 0    add chair chair.obj size 0.9 up z        longest side (m); axis of the file that points up
///     frame 0    add ball ball.obj density 600 friction 0.3 restitution 0.8     kg/m3, 1..30000; friction on
///                                                 the room 0..10; 0..1. Or mass 0.5 instead of density, kg
///     frame 10   drop pot view height 0.3         above the free level surface nearest to the image centre
///     frame 11   drop pot near 0.4 -0.1 0.7       above the one nearest to this point, at most 25 cm away
///     time 2.5   drop pot at 0.4 -0.1 0.75 height 0.3
///     time 4     place pot 0.4 -0.1 0.9
///     time 4     stand pot 0.4 -0.1 0.75 0 0 0.6 0.8     exactly there, asleep; unit quaternion x y z w
///     time 5     throw pot 0.4 -0.1 1.2 velocity 1 0 0.5
///     time 5.5   throw pot 0.4 -0.1 1.2 velocity 1 0 0.5 spin 0 6 0     at most 20 m/s, 60 rad/s about x y z
///     time 5.5   turn pot 0 0 45                  about the world's axes (degrees)
///     time 5.6   carry pot 0.4 -0.1 1.0           moved to this position and held there
///     time 5.9   release pot velocity 0 0 0
///     time 5.9   material pot mass 2 friction 0.1       others are unchanged; also density, restitution
///     time 6     remove pot
///     time 7     commit                          stationary objects in view are added to the map
///     frame 200  surfaces skirt                   holes, skirt, border or map
///     frame 210  unknown solid                    or free
///     frame 220  radar sampled 64                 mode exact, sampled or passes; resolution in pixels
///     frame 225  quality depth_stride 2 shadows off       others as on the command line, or default
///     frame 226  quality from physics move_every_n_frames 4      from the physics stage on; or mesh, compose
///     frame 230  camera hold                      repeats this frame; or go, rewind, loop, stay, resume
///     frame 300  quit
///
/// place, throw and drop put an object that would overlap another object on top of it, if no surface of the
/// room is in the way. These three actions may end with `turned YAW PITCH ROLL`: degrees about z, then about
/// the rotated y axis, then about the rotated x axis. Without `turned`, an object keeps its last orientation,
/// initially upright.
///
/// Throws Error "FILE:LINE: ..." with the text found and the text expected. Errors in words are unknown,
/// missing and surplus words, and names that are not added or added twice. Errors in numbers are malformed,
/// non-finite and out-of-range numbers, and negative frames and times. Throws Error for a file that is
/// unreadable, binary or longer than 64 MiB.
Script read_script(const std::filesystem::path& path, LastLine last_line = LastLine::kWhole);

/// Parses the text of an events file. Error messages contain `where` in place of the file's name. Relative
/// mesh paths are returned unchanged.
Script parse_script(std::string_view text, std::string_view where);

/// Returns the event as a line of an events file, without a line end. parse_script() restores all fields
/// exactly, except ScriptEvent::line and ObjectSource::origin.
std::string to_line(const ScriptEvent& event);

}  // namespace roomradar
