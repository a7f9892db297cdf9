// sim_options.hpp: what to simulate, and the form in which a user asks for it on the command line.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

enum class CameraPathKind {
  kScan,   ///< walks round the room and back to the start, looking across it
  kView,   ///< stands still, as a hand can, and looks at the room's focus
  kSwing,  ///< swings about before the focus, near and far, tilted every way, as one looks at a checkerboard
};
enum class MoverKind {
  kHand,    ///< a hand and forearm that reach over the focus and withdraw
  kBall,    ///< a ball that rolls to and fro
  kPerson,  ///< a person-sized body that walks through the room
};
/// When the things that move do so.
enum class Pace {
  kSteady,  ///< all the time
  kSlow,    ///< at a third of that speed
  kWaits,   ///< stand still for 2 s, go on for 2 s, and so on
  kLeaves,  ///< stand still from the first frame on, and leave the room when half of the frames are over
};
/// One more thing in the room: a crate where else a ball could roll.
enum class CrateKind {
  kNone,
  kStays,  ///< part of the room
  kComes,  ///< not there, and there from one frame to the next when half of the frames are over
  kGoes,   ///< there, and gone from one frame to the next when half of the frames are over
};
std::string_view to_string(CameraPathKind kind);
std::string_view to_string(MoverKind kind);
std::string_view to_string(Pace pace);
std::string_view to_string(CrateKind kind);  ///< as a spec has it: 0, 1, comes, goes

/// The Kinect's depth camera at its full size.
inline constexpr Intrinsics kKinectDepthCamera{640, 480, 585.0, 585.0, 320.0, 240.0};

/// The same with images of another width, 4:3.
Intrinsics kinect_of_width(int width_px);

struct SimOptions {
  std::string room = "table";  ///< one of room_names(), kRandomRoom or kBoardRoom
  std::uint64_t seed = 1;      ///< of the camera's path, the movers' phase, the noise, and a random room
  std::int64_t frames = 300;   ///< 1 or more
  double rate_hz = 30.0;       ///< frames a second, > 0
  CameraPathKind path = CameraPathKind::kScan;
  std::vector<MoverKind> movers;  ///< each at most once
  Pace pace = Pace::kSteady;      ///< of all movers
  CrateKind crate = CrateKind::kNone;
  double noise_scale = 1.0;  ///< times the Kinect's noise; 0: clean depth, without shadow or dropouts
  Intrinsics depth_camera = kKinectDepthCamera;
  bool faults = false;            ///< the cameras are not quite what the frames say; see sensor_faults.hpp
  bool registered_colour = true;  ///< false: a colour camera of its own, 2.5 cm beside the depth camera
  bool with_colour = true;        ///< false: depth alone, several times as fast
};

/// Reads `sim:ROOM`, or `sim:ROOM?key=value&key=value` with the keys
///   seed, frames, rate, path (scan, view, swing), moving (hand, ball, person; several with commas), pace
///   (steady, slow, waits, leaves), noise (0 = off, 1 = Kinect), crate (0, 1: one more thing in the room;
///   comes, goes: at half time), width (of the image, 4:3, 64 to 1920 pixels), colour (registered, separate,
///   none), faults (0, 1: the cameras are not quite what the frames say).
/// Throws Error naming the key or value that is not known, or out of range, and listing what is.
SimOptions parse_sim_spec(std::string_view spec);

/// The shortest spec that parses to `options`, where the depth camera is a scaled Kinect.
std::string sim_spec(const SimOptions& options);

/// Throws Error naming the field and the rule.
void require_valid(const SimOptions& options);

}  // namespace roomradar
