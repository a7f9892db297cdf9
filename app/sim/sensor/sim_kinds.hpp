// sim_kinds.hpp: kinds of camera paths, moving objects and crates of a simulation, with their names in
// sources such as sim:table?path=view, see parse_sim_spec().
#pragma once
#include <string_view>

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

}  // namespace roomradar
