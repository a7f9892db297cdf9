// script_event.hpp: one event of a run: an action of a virtual object or of the session, and its time.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>

#include "app/objects/object_file.hpp"
#include "app/quality/frame_load.hpp"
#include "app/quality/quality.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "radar/exact/cyber_radar.hpp"

namespace roomradar {

enum class Action {
  kAdd,       ///< load a mesh; not in the room until placed, dropped or thrown
  kPlace,     ///< put it at a position, without velocity
  kDrop,      ///< let it fall from above a point, or from above a level surface in view
  kThrow,     ///< put it at a position with a velocity
  kRemove,    ///< take it out of the room
  kTurn,      ///< rotate it about its centre until something is in the way
  kCarry,     ///< hold it and move it to a position, until something is in the way; lasts until kRelease
  kRelease,   ///< let go of a carried object, with a velocity
  kSurfaces,  ///< change which surfaces can be touched
  kUnknown,   ///< make unknown space free or solid
  kRadar,     ///< change the radar's mode and resolution
  kQuality,   ///< change the quality
  kCamera,    ///< change which frame of the source is next
  kCommit,    ///< commit objects in view that stand still, or are gone, to the map
  kQuit,      ///< end the run before this frame
};

/// The frame that follows the current one.
enum class CameraPlay {
  kHold,    ///< the same frame, repeatedly, while time continues
  kGo,      ///< the source's next frame
  kRewind,  ///< the source's first frame
  kLoop,    ///< at the end of the source, its first frame
  kStay,    ///< at the end of the source, its last frame, held
  kResume,  ///< next frame, 1/30 s after the last, since a device's clock runs on during a pause
};

inline constexpr double kMaxTurn_deg = 3600.0;  ///< max angle of one kTurn, per axis

/// One line of a script (script.hpp). Positions are those of the object's origin, in the world (m, +z up).
struct ScriptEvent {
  int line = 0;                       ///< line in the file, from 1; 0: not from a file
  std::optional<std::int64_t> frame;  ///< due before this frame of the run, from 0; alternative to time_s
  std::optional<double> time_s;       ///< due before the first frame at or after this time of the run
  Action action = Action::kQuit;
  std::string name;              ///< name of the object; empty for actions without an object
  std::string mesh;              ///< kAdd: `teapot`, or a mesh file, relative to the script's folder
  std::optional<double> size_m;  ///< kAdd: length of the longest side after scaling; unset: not scaled
  std::optional<UpAxis> up;      ///< kAdd: axis of the file that points up; unset: the format's
  /// kAdd: kAsInFile in sessions recorded before origins were brought near.
  ModelOrigin origin = ModelOrigin::kNear;
  /// kPlace, kDrop, kThrow, kCarry. kDrop without a position: over a surface in view.
  std::optional<Eigen::Vector3d> position_world;
  /// kDrop without a position: over the surface in view nearest to this point; unset: nearest to the view's
  /// middle.
  std::optional<Eigen::Vector3d> near_world;
  double height_m = 0.3;  ///< kDrop: initial height of its lowest point above the position or surface
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< kThrow, kRelease: velocity of the centre
                                                                 ///< of mass
  Eigen::Vector3d angular_velocity_world_rad_s =
      Eigen::Vector3d::Zero();  ///< kThrow: angular velocity, right-handed
  /// kPlace, kDrop, kThrow: orientation; unset: unchanged.
  std::optional<Eigen::Matrix3d> R_world_object;
  Eigen::Vector3d turned_deg = Eigen::Vector3d::Zero();  ///< R_world_object as yaw, pitch, roll, as in the
                                                         ///< file
  Eigen::Vector3d turn_world_deg = Eigen::Vector3d::Zero();  ///< kTurn: rotation vector, axis times angle
  SurfacePolicy surfaces = SurfacePolicy::kMap;              ///< kSurfaces
  bool unknown_is_solid = false;                             ///< kUnknown
  RadarConfig radar;                                         ///< kRadar
  RunQuality quality;                                        ///< kQuality
  FramePart from = FramePart::kLocate;  ///< kQuality: first part of the due frame that uses it
  CameraPlay camera = CameraPlay::kGo;  ///< kCamera
};

/// Returns the model that a kAdd event names.
ObjectSource source_of(const ScriptEvent& add);
/// Returns true if the action is followed by an object's name.
bool has_object(Action action);

/// Returns true if an event is due before a frame, by frame number or by time.
bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s);

}  // namespace roomradar
