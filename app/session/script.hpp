// script.hpp: the events file of `roomradar run --script FILE`: what the virtual objects do, and when.
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
  kAdd,       ///< load a mesh; it is not in the room until it is placed, dropped or thrown
  kPlace,     ///< put it at a position, at rest in mid-air until the next step of physics
  kDrop,      ///< let it fall from above a point, or from above a level surface in view
  kThrow,     ///< put it at a position with a velocity
  kRemove,    ///< take it out of the room
  kTurn,      ///< turn it about its middle, as far as nothing is in the way
  kCarry,     ///< it is held, and goes to a position as far as nothing is in the way; until it is let go
  kRelease,   ///< let go of what is carried, with a velocity
  kSurfaces,  ///< from now on this can be touched
  kUnknown,   ///< from now on space that nobody has seen is free, or solid
  kRadar,     ///< from now on contacts are found so
  kQuality,   ///< from now on so much is traded for time
  kCamera,    ///< how the source goes on from this frame
  kCommit,    ///< what stands still now in view, or has gone, becomes part of the room
  kQuit,      ///< end the run before this frame
};

/// What follows a frame.
enum class CameraPlay {
  kHold,    ///< this frame again and again, while time goes on
  kGo,      ///< the source's next frame
  kRewind,  ///< the source's first frame
  kLoop,    ///< at the end of the source its first frame follows
  kStay,    ///< at the end of the source its last frame is held
  kResume,  ///< the source's next frame, 1/30 s later: there was a pause, and a device's clock went on
};

inline constexpr double kMaxTurn_deg = 3600.0;  ///< of one turn, about each axis

/// One line of the file. Positions are of the object's origin, in the world (m, +z up).
struct ScriptEvent {
  int line = 0;                       ///< in the file, from 1; 0 in a script made in code
  std::optional<std::int64_t> frame;  ///< before this frame of the run, from 0; either this ...
  std::optional<double> time_s;       ///< ... or before the first frame at or after this time of the run
  Action action = Action::kQuit;
  std::string name;              ///< of the object; empty where the action is of none
  std::string mesh;              ///< kAdd: `teapot`, or a mesh file, relative to the script's folder
  std::optional<double> size_m;  ///< kAdd: scaled so that its longest side is this; as it is if absent
  /// kPlace, kDrop, kThrow, kCarry; kDrop without one: over a surface in view.
  std::optional<Eigen::Vector3d> position_world;
  double height_m = 0.3;  ///< kDrop: its lowest point starts this far above the position or surface
  Eigen::Vector3d velocity_world_mps = Eigen::Vector3d::Zero();  ///< kThrow, kRelease: of the centre of mass
  Eigen::Vector3d angular_velocity_world_rad_s = Eigen::Vector3d::Zero();  ///< kThrow: about it, right-handed
  /// kPlace, kDrop, kThrow: how it stands; as it stood last if absent.
  std::optional<Eigen::Matrix3d> R_world_object;
  Eigen::Vector3d turned_deg = Eigen::Vector3d::Zero();  ///< the same as yaw, pitch, roll, as a line says it
  Eigen::Vector3d turn_world_deg = Eigen::Vector3d::Zero();  ///< kTurn: axis times angle
  SurfacePolicy surfaces = SurfacePolicy::kMap;              ///< kSurfaces
  bool unknown_is_solid = false;                             ///< kUnknown
  RadarConfig radar;                                         ///< kRadar
  RunQuality quality;                                        ///< kQuality
  FramePart from = FramePart::kLocate;                       ///< kQuality: of the frame it is due in
  CameraPlay camera = CameraPlay::kGo;                       ///< kCamera
};

/// In the order of the file, which is the order in which they happen: one that is due waits for those before
/// it. Numbers are finite; a name is added before it is used and not added twice.
struct Script {
  std::vector<ScriptEvent> events;
};

/// Whether a last line without its end is an event, or what a program wrote when it was killed.
enum class LastLine { kWhole, kMayBeCut };

/// Reads an events file. One event a line, words between blanks, # begins a comment:
///
///     frame 0    add pot teapot size 0.2
///     frame 10   drop pot view height 0.3         over a level surface that the camera sees
///     time 2.5   drop pot at 0.4 -0.1 0.75 height 0.3
///     time 4     place pot 0.4 -0.1 0.9
///     time 5     throw pot 0.4 -0.1 1.2 velocity 1 0 0.5
///     time 5.5   throw pot 0.4 -0.1 1.2 velocity 1 0 0.5 spin 0 6 0       spin in rad/s about x y z; nothing
///                                                              moves faster than 20 m/s, or spins than 60
///                                                              rad/s
///     time 5.5   turn pot 0 0 45                  about the world's axes (degrees)
///     time 5.6   carry pot 0.4 -0.1 1.0           held in the air, on its way there
///     time 5.9   release pot velocity 0 0 0
///     time 6     remove pot
///     time 7     adopt                           what stands still now in view becomes part of the room
///     frame 200  surfaces skirt                   holes, skirt, border or map
///     frame 210  unknown solid                    or free
///     frame 220  radar sampled 64                 exact or sampled; pixels
///     frame 225  quality depth_stride 2 shadows off       what is not named is as usual; options stay
///     frame 226  quality from physics move_every_n_frames 4      from that part on; mesh, compose
///     frame 230  camera hold                      this frame stays; go, rewind, loop, stay, resume
///     frame 300  quit
///
/// What would begin inside another object begins on top of it, if the room is not in the way.
/// place, drop and throw may end with `turned YAW PITCH ROLL`: degrees about z, then y, then x, each of them
/// the axes as they were turned before. Without it an object stands as it stood last, upright at first.
///
/// @param last_line  of a file that a program was writing when it was killed, a last line without its end is
///                   not an event
/// Throws Error "FILE:LINE: ..." with what was found and what is wanted for: an unknown word, a missing or
/// surplus word, a number that is none, not finite or out of range, a negative frame or time, a name that was
/// not added (or was twice), a file that cannot be read, is binary or longer than 64 MiB.
Script read_script(const std::filesystem::path& path, LastLine last_line = LastLine::kWhole);

/// The same from text; `where` stands for the file's name in messages, mesh paths stay as they are.
Script parse_script(std::string_view text, std::string_view where);

/// The event as a line of the file, without the line's end. parse_script() reads the very same event from it,
/// to the last bit of its numbers.
std::string to_line(const ScriptEvent& event);

/// Whether an event is due before a frame: its frame number is reached, or its time.
bool is_due(const ScriptEvent& event, std::int64_t run_frame, double run_time_s);

}  // namespace roomradar
