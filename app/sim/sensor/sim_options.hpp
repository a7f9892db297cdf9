// sim_options.hpp: options of the simulation, and their command-line syntax.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/types/intrinsics.hpp"

namespace roomradar {

enum class CameraPathKind {
  kScan,   ///< walks around the room and back to the start, looking across it
  kView,   ///< hand-held at one place, looking at the room's focus
  kSwing,  ///< swings in front of the focus, near, far and tilted, to calibrate
};
enum class MoverKind {
  kHand,    ///< a hand and forearm that reach over the focus and withdraw
  kBall,    ///< a ball that rolls back and forth
  kPerson,  ///< a person-sized body that walks through the room
};
/// Timing of the movers.
enum class Pace {
  kSteady,  ///< continuous
  kSlow,    ///< a third of that speed
  kWaits,   ///< alternates between 2 s still and 2 s moving
  kLeaves,  ///< still from the first frame on; leaves the room after half of the frames
};
/// An additional crate on the ball's path.
enum class CrateKind {
  kNone,
  kStays,  ///< part of the room
  kComes,  ///< appears between two frames, after half of the frames
  kGoes,   ///< disappears between two frames, after half of the frames
};
std::string_view to_string(CameraPathKind kind);
std::string_view to_string(MoverKind kind);
std::string_view to_string(Pace pace);
std::string_view to_string(CrateKind kind);  ///< as in a spec: 0, 1, comes, goes

/// The Kinect's depth camera at full resolution.
inline constexpr Intrinsics kKinectDepthCamera{640, 480, 585.0, 585.0, 320.0, 240.0};

/// Returns the Kinect's depth camera scaled to images of this width, 4:3.
Intrinsics kinect_of_width(int width_px);

struct SimOptions {
  std::string room = "table";  ///< one of room_names(), kRandomRoom or kBoardRoom
  std::uint64_t seed = 1;      ///< of camera path, movers' phase, noise, and a random room
  std::int64_t frames = 300;   ///< >= 1
  double rate_hz = 30.0;       ///< frames per second, > 0
  CameraPathKind path = CameraPathKind::kScan;
  std::vector<MoverKind> movers;  ///< each at most once
  Pace pace = Pace::kSteady;      ///< of all movers
  CrateKind crate = CrateKind::kNone;
  double noise_scale = 1.0;  ///< factor on the Kinect's noise; 0: exact depth, without shadow or dropouts
  Intrinsics depth_camera = kKinectDepthCamera;
  bool faults = false;  ///< the true cameras differ from those the frames declare; see sensor_faults.hpp
  bool registered_colour = true;  ///< false: a separate colour camera 2.5 cm beside the depth camera
  bool with_colour = true;        ///< false: depth only, several times as fast
};

/// Parses `sim:ROOM`, or `sim:ROOM?key=value&key=value` with the keys
///   seed, frames, rate, path (scan, view, swing), moving (hand, ball, person; several with commas), pace
///   (steady, slow, waits, leaves), noise (0 = off, 1 = Kinect), crate (0, 1: an additional crate; comes,
///   goes: at half time), width (of the image, 4:3, 64 to 1920 pixels), colour (registered, separate, none),
///   faults (0, 1: the true cameras differ from those the frames declare).
/// Throws Error naming a key or value that is unknown or out of range, and listing the valid ones.
SimOptions parse_sim_spec(std::string_view spec);

/// Returns the shortest spec that parses to `options`; the depth camera must be a scaled Kinect.
std::string sim_spec(const SimOptions& options);

/// Throws Error naming the field and the rule.
void require_valid(const SimOptions& options);

}  // namespace roomradar
