// sim_options.hpp: options of the simulated Kinect, and their command-line syntax.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/sim/building/building_plan.hpp"
#include "mapping/types/intrinsics.hpp"

namespace roomradar {

enum class CameraPathKind {
  /// The camera moves around the room, back to its start, and looks across the room.
  kScan,
  /// The hand-held camera stays at one position and looks at Room::focus_world.
  kView,
  /// For calibration: the camera views Room::focus_world from varying distances and tilts.
  kSwing,
};
enum class MoverKind {
  /// A hand and forearm that reach over Room::focus_world and withdraw.
  kHand,
  /// A ball that rolls back and forth.
  kBall,
  /// A person-sized body that walks through the room.
  kPerson,
};
/// Timing of the moving objects.
enum class Pace {
  /// Moves continuously.
  kSteady,
  /// Moves continuously at a third of kSteady's speed.
  kSlow,
  /// Alternates between 2 s at rest and 2 s of motion.
  kWaits,
  /// Rests from the first frame on, and leaves the room after half of the frames.
  kLeaves,
};
/// An additional crate on the ball's path.
enum class CrateKind {
  kNone,
  /// The crate is part of the room.
  kStays,
  /// The crate appears between two frames, after half of the frames.
  kComes,
  /// The crate disappears between two frames, after half of the frames.
  kGoes,
};
std::string_view to_string(CameraPathKind kind);
std::string_view to_string(MoverKind kind);
std::string_view to_string(Pace pace);
/// Returns the value's name in a source, see parse_sim_spec(): 0, 1, comes or goes.
std::string_view to_string(CrateKind kind);

/// The Kinect's depth camera at full resolution.
inline constexpr Intrinsics kKinectDepthCamera{640, 480, 585.0, 585.0, 320.0, 240.0};

/// Returns the Kinect's depth camera scaled to 4:3 images of this width.
Intrinsics kinect_of_width(int width_px);

/// Timing of the simulated sensor. Frames do not contain this timing: Frame::timing and
/// Frame::colour_after_depth_s remain 0.
struct SimTiming {
  /// Readout time of both images, 0 to 0.05 s: each row shows the view at its own time.
  double shutter_s = 0.0;
  /// Time of the colour image after the depth image, -0.1 to 0.1 s.
  double delay_s = 0.0;
  /// Exposure of the colour image, 0 to 0.05 s: the image is the mean of views within that time.
  double exposure_s = 0.0;
  friend bool operator==(const SimTiming&, const SimTiming&) = default;
};

struct SimOptions {
  /// Name of the room: one of room_names(), kRandomRoom, kFlatRoom, kBuildingRoom or kBoardRoom.
  std::string room = "table";
  /// Seed of the camera path, the phases of moving objects, the noise, and the furniture of a random room,
  /// flat or building.
  std::uint64_t seed = 1;
  /// Number of frames, >= 1. For the building, 0 means the whole walk, and frames beyond the walk are not
  /// delivered.
  std::int64_t frames = 300;
  /// Size of the building. All walks of one seed and size are in the same building, with the same world
  /// frame.
  BuildingSize building;
  /// Number of the walk (camera trajectory through the building): 0 to kLastWalk, or kRingWalk. It also seeds
  /// the path's sway and the noise.
  int walk = 0;
  /// Frames per second, > 0.
  double rate_hz = 30.0;
  CameraPathKind path = CameraPathKind::kScan;
  /// Moving objects, each kind at most once.
  std::vector<MoverKind> movers;
  /// Timing of all moving objects.
  Pace pace = Pace::kSteady;
  CrateKind crate = CrateKind::kNone;
  /// Share of the pieces of furniture of a random room that stand elsewhere than they do at 0, 0 to 1. If >
  /// 0, the camera path and the noise are others, too, as on another day.
  double moved = 0.0;
  /// Factor on the Kinect's noise. 0: exact depth, without shadow or dropouts.
  double noise_scale = 1.0;
  Intrinsics depth_camera = kKinectDepthCamera;
  /// True: the true cameras differ from those that the frames declare; see sensor_faults.hpp.
  bool faults = false;
  /// True: colour images are rendered in the depth camera, so depth and colour are registered. False: the
  /// colour camera has a baseline of 2.5 cm to the depth camera.
  bool registered_colour = true;
  /// False: frames have depth only, which is several times as fast.
  bool with_colour = true;
  SimTiming timing;
  /// Max speed, degrees/s, of swings of 25 degrees to each side that are added to the path; 0: none.
  double turn_dps = 0.0;
};

/// Parses `sim:ROOM`, or `sim:ROOM?key=value&key=value` with the keys
///   seed, frames, rate, path (scan, view, swing), moving (hand, ball, person; several with commas), pace
///   (steady, slow, waits, leaves), noise (0: none, 1: as a Kinect), crate (0, 1: an additional crate; comes,
///   goes: after half of the frames), moved (0 to 1: share of a random room's furniture that stands
///   elsewhere, scanned on another path), width (of the image, 4:3, 64 to 1920 pixels), colour (registered,
///   separate, none), faults (0, 1: the true cameras differ from those that frames declare), shutter (ms:
///   readout of depth and colour), delay (ms: colour after depth), exposure (ms: blur of colour), turn
///   (degrees/s: the camera swings this fast); and for the building rooms, floors, alike (rooms that look
///   like another one) and walk (a number or ring). The building's frames are by default its whole walk.
/// @throws Error naming the key or value that is unknown or out of range, and the valid ones
SimOptions parse_sim_spec(std::string_view spec);

/// Returns the shortest spec that parse_sim_spec() converts to `options`. The depth camera must be a result
/// of kinect_of_width().
std::string sim_spec(const SimOptions& options);

/// Throws Error naming the field and the rule if a value is out of range.
void require_valid(const SimOptions& options);

}  // namespace roomradar
