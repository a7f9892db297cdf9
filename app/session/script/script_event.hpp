// script_event.hpp: one event of a run: its time, and its action on a virtual object or the session.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "app/objects/object_file.hpp"
#include "app/physics/body_material.hpp"
#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

enum class Action {
  kAdd,       ///< load an object's mesh; the object is outside the room until another action puts it there
  kPlace,     ///< put an object at a position, with zero velocity
  kDrop,      ///< let an object fall from above a point, or from above a level surface in view
  kThrow,     ///< put an object at a position, with a velocity
  kMaterial,  ///< change an object's mass, density, friction or restitution
  kRemove,    ///< take an object out of the room
  kTurn,      ///< rotate an object about its centre until the first contact
  /// Move an object towards a position and hold it there until kRelease. Obstacles stop it. An object outside
  /// the room is put at the position.
  kCarry,
  kRelease,   ///< let go of a carried object, with a velocity
  kSurfaces,  ///< change which surfaces can be touched
  kUnknown,   ///< make unknown space free or solid
  kRadar,     ///< change the radar's mode and resolution
  kQuality,   ///< change quality settings, from the frame's stage ScriptEvent::from on
  kCamera,    ///< change which frame of the source is next
  /// Add stationary objects in view to the session's copy of the map, and remove vanished objects from the
  /// copy. The request expires after 1 s.
  kCommit,
  kQuit,  ///< end the run before this frame
};

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

inline constexpr double kMaxTurn_deg = 3600.0;  ///< max angle of one kTurn, per axis

/// One line of a script (script.hpp). Positions are in the world frame (m, +z up).
struct ScriptEvent {
  int line = 0;  ///< 1-based line number in the file; 0: not from a file
  /// Index, from 0, of the run's frame before which the event is due. Alternative to time_s.
  std::optional<std::int64_t> frame;
  /// The event is due before the first frame at or after this time of the run.
  std::optional<double> time_s;
  Action action = Action::kQuit;
  std::string name;  ///< name of the object; empty for actions without an object
  /// kAdd: `teapot`, or a mesh file; in a script, relative to the script's folder.
  std::string mesh;
  std::optional<double> size_m;  ///< kAdd: length of the longest side after scaling; unset: not scaled
  std::optional<UpAxis> up;      ///< kAdd: axis of the file that points up; unset: the format's default
  BodyMaterial material;         ///< an unset value is the default (kAdd) or unchanged (kMaterial)
  /// kAdd: origin of the model. kAsInFile is only for replaying sessions recorded before kNear was
  /// introduced.
  ModelOrigin origin = ModelOrigin::kNear;
  /// kPlace, kThrow, kCarry: position of the object's origin. kDrop: x and y of the object's origin, and the
  /// height z above which the object is dropped. Unset (kDrop only): the object is dropped above a level
  /// surface in view.
  std::optional<Eigen::Vector3d> position_world;
  /// kDrop without a position. Set: the drop is above the free level place nearest to near_world, at most 25
  /// cm away; without such a place, it is cancelled with a notice. Unset: it is above the free level place
  /// nearest to the image centre, and waits for a later frame if there is none.
  std::optional<Eigen::Vector3d> near_world;
  /// kDrop: initial height of the object's lowest vertex above the position or surface. Without a position,
  /// it is reduced to 5 cm if the object would not stay otherwise.
  double height_m = 0.3;
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< kThrow, kRelease: velocity of the centre
                                                                 ///< of mass
  Eigen::Vector3d angular_velocity_world_rad_s =
      Eigen::Vector3d::Zero();  ///< kThrow: angular velocity, right-handed
  /// kPlace, kDrop, kThrow: orientation; unset: unchanged.
  std::optional<Eigen::Matrix3d> R_world_object;
  /// R_world_object as yaw, pitch and roll, as written in the file.
  Eigen::Vector3d turned_deg = Eigen::Vector3d::Zero();
  Eigen::Vector3d turn_world_deg = Eigen::Vector3d::Zero();  ///< kTurn: rotation vector, axis times angle
  SurfacePolicy surfaces = SurfacePolicy::kMap;              ///< kSurfaces
  bool unknown_is_solid = false;                             ///< kUnknown
  RadarConfig radar;                                         ///< kRadar
  RunQuality quality;                                        ///< kQuality
  FramePart from = FramePart::kLocate;  ///< kQuality: first processing stage of the frame that uses `quality`
  CameraPlay camera = CameraPlay::kGo;  ///< kCamera
};

/// Returns the model that a kAdd event names.
ObjectSource source_of(const ScriptEvent& add);
/// Returns true if an object's name follows the action in a script.
bool has_object(Action action);

/// Returns true if an event is due before a frame with this index and time in the run.
bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s);

}  // namespace roomradar
