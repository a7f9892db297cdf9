// script.hpp: events file of `roomradar run --script FILE`: actions of the virtual objects, and their times.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  kTurn,      ///< rotate it about its middle until something is in the way
  kCarry,     ///< hold it and move it to a position, until something is in the way; lasts until kRelease
  kRelease,   ///< let go of a carried object, with a velocity
  kSurfaces,  ///< change which surfaces can be touched
  kUnknown,   ///< make unknown space free or solid
  kRadar,     ///< change the radar's mode and resolution
  kQuality,   ///< change the quality
  kCamera,    ///< change which frame of the source follows
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
  kResume,  ///< the next frame, 1/30 s after the last: a device's clock ran on during a pause
};

inline constexpr double kMaxTurn_deg = 3600.0;  ///< max angle of one kTurn, per axis

/// One line of the file. Positions are those of the object's origin, in the world (m, +z up).
struct ScriptEvent {
  int line = 0;                       ///< in the file, from 1; 0 in a script made in code
  std::optional<std::int64_t> frame;  ///< due before this frame of the run, from 0; alternative to time_s
  std::optional<double> time_s;       ///< due before the first frame at or after this time of the run
  Action action = Action::kQuit;
  std::string name;              ///< the object's; empty for actions without an object
  std::string mesh;              ///< kAdd: `teapot`, or a mesh file, relative to the script's folder
  std::optional<double> size_m;  ///< kAdd: length of the longest side after scaling; unset: not scaled
  /// kPlace, kDrop, kThrow, kCarry. kDrop without a position: over a surface in view.
  std::optional<Eigen::Vector3d> position_world;
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

/// Events in the order of the file, which is the order of execution: a due event waits for the events before
/// it. All numbers are finite. Each name is added once, before its first use.
struct Script {
  std::vector<ScriptEvent> events;
};

/// Treatment of a last line without a line end: an event, or possibly cut off when its writer was killed.
enum class LastLine { kWhole, kMayBeCut };

/// Reads an events file. One event per line, words separated by blanks, # begins a comment:
///
///     frame 0    add pot teapot size 0.2
///     frame 10   drop pot view height 0.3         over a level surface that the camera sees
///     time 2.5   drop pot at 0.4 -0.1 0.75 height 0.3
///     time 4     place pot 0.4 -0.1 0.9
///     time 5     throw pot 0.4 -0.1 1.2 velocity 1 0 0.5
///     time 5.5   throw pot 0.4 -0.1 1.2 velocity 1 0 0.5 spin 0 6 0       spin in rad/s about x y z; speeds
///                                                              are limited to 20 m/s, spins to 60 rad/s
///     time 5.5   turn pot 0 0 45                  about the world's axes (degrees)
///     time 5.6   carry pot 0.4 -0.1 1.0           held in the air, on its way there
///     time 5.9   release pot velocity 0 0 0
///     time 6     remove pot
///     time 7     adopt                           objects in view that stand still become part of the room
///     frame 200  surfaces skirt                   holes, skirt, border or map
///     frame 210  unknown solid                    or free
///     frame 220  radar sampled 64                 exact or sampled; pixels
///     frame 225  quality depth_stride 2 shadows off       others get their defaults; options keep theirs
///     frame 226  quality from physics move_every_n_frames 4      from that part on; mesh, compose
///     frame 230  camera hold                      repeats this frame; go, rewind, loop, stay, resume
///     frame 300  quit
///
/// An object that would begin inside another one begins on top of it, if the room leaves space there. place,
/// drop and throw may end with `turned YAW PITCH ROLL`: degrees about z, then the rotated y, then the rotated
/// x axis. Without it an object keeps its last orientation, initially upright.
///
/// @param last_line  kMayBeCut: a last line without a line end is ignored, for a file whose writer was killed
/// Throws Error "FILE:LINE: ..." with the text found and the text expected. Reasons: an unknown, missing or
/// surplus word; a number that is malformed, not finite or out of range; a negative frame or time; a name not
/// added, or added twice; a file that is unreadable, binary or longer than 64 MiB.
Script read_script(const std::filesystem::path& path, LastLine last_line = LastLine::kWhole);

/// Parses an events file's text. `where` replaces the file's name in messages; mesh paths are unchanged.
Script parse_script(std::string_view text, std::string_view where);

/// Returns the event as a line of the file, without a line end. parse_script() restores the same event from
/// it, bit by bit.
std::string to_line(const ScriptEvent& event);

/// Returns true if an event is due before a frame, by frame number or by time.
bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s);

}  // namespace roomradar
