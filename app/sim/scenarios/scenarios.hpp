// scenarios.hpp: drops and pushes onto surfaces that the camera cannot see now but saw in the prescan.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/scenarios/scenario_object.hpp"
#include "app/sim/sensor/sim_options.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// What hides the surface that ought to stop the object.
enum class Occluder {
  kFurniture,  ///< the room itself, seen from where the camera stands now
  kBox,        ///< a box carried between the camera and the surface
  kHand,       ///< a hand and arm, every other one passing by
  kPerson,     ///< a person who stands between
};
std::string_view to_string(Occluder occluder);

/// Of a walk once round a room.
inline constexpr std::int64_t kScenarioPrescanFrames = 720;

/// A room with the path of its prescan, which all its scenarios share: one map a room serves them all.
struct ScenarioRoom {
  Room room;
  SimOptions prescan;                              ///< the frames to map the room from, without moving things
  std::vector<Eigen::Isometry3d> T_world_prescan;  ///< every tenth pose of it
};
/// @param seed  of the camera's path; of the furniture too if the room is `random`
/// Throws Error if there is no such room.
ScenarioRoom make_scenario_room(std::string_view name, std::uint64_t seed = 1);

/// The object moves this long between two frames of the camera.
inline constexpr double kScenarioFrame_s = 1.0 / 30.0;

/// One object that moves straight until something stops it.
struct Scenario {
  std::uint64_t seed = 0;
  std::int64_t number = 0;
  std::string room;
  Occluder occluder = Occluder::kFurniture;
  std::vector<Solid> occluder_solids;  ///< in the room while the object moves, not in the prescan; at frame 0
  std::vector<Material> occluder_materials;
  Eigen::Vector3d occluder_velocity_world = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();   ///< while the object moves
  /// Where tracking believes that the camera is: some millimetres and tenths of a degree off.
  Eigen::Isometry3d T_world_believed = Eigen::Isometry3d::Identity();
  Intrinsics depth_camera = kKinectDepthCamera;

  ScenarioObject object;
  Mesh object_mesh;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< where it starts, clear of everything
  Eigen::Vector3d direction_world = -Eigen::Vector3d::UnitZ();       ///< unit
  double speed_m_s = 0.0;
  double limit_m = 0.0;        ///< how far it moves if nothing stops it: 0.4 m beyond the true contact
  double true_travel_m = 0.0;  ///< to the first contact with the room
  Eigen::Vector3d contact_world = Eigen::Vector3d::Zero();  ///< where that is
};

/// How far the object moves in one frame; up to 33 cm.
inline double step_m(const Scenario& scenario) { return scenario.speed_m_s * kScenarioFrame_s; }
/// The frame that shows the room when the object begins the step in which it meets the true surface.
inline int contact_frame(const Scenario& scenario) {
  return static_cast<int>(scenario.true_travel_m / step_m(scenario));
}
/// The occluder's solids while frame `frame` is taken.
std::vector<Solid> occluder_at(const Scenario& scenario, int frame);

/// Scenario `number` of a seed; the same whatever else was made. What holds of it:
///  - every point of the room that could stop the object up to 5 cm behind the true contact is hidden from
///    the camera in the contact frame, though the contact lies within its image;
///  - each of those points was seen by at least three of T_world_prescan, from 0.6 to 3.5 m and not grazing;
///  - so was the space on the object's way: it never enters what nobody has seen;
///  - the object starts at least 2 cm from the room, and its way keeps 4 cm from the occluder;
///  - moved 5 mm aside, to any of four sides, it would still be stopped no more than 15 mm later or sooner:
///    what hangs on less than the map's cells is no question to put to a map.
/// Four scenarios of drops and four of pushes take turns, in each four the kinds of occluder, which hide at
/// least half of the stopping surface themselves; the shapes of objects take turns too. Where a room has no
/// place for one within some thousand draws, the next kind of occluder is tried, and then the next shape.
/// Throws Error if the room has none at all.
Scenario make_scenario(const ScenarioRoom& room, std::uint64_t seed, std::int64_t number);

/// The depth frame that the camera delivers: the room and the occluder, without colour.
/// @param noise_scale  as in SimOptions; 0: exact
void render_scenario(const Scenario& scenario, const Room& room, int frame_number, double noise_scale,
                     Frame& frame);

enum class Outcome {
  kStoppedRight,
  kPassedThrough,  ///< more than 2 cm beyond the true contact
  kStoppedFalse,   ///< more than 3 cm before it
};
std::string_view to_string(Outcome outcome);
struct Verdict {
  Outcome outcome = Outcome::kStoppedRight;
  double error_m = 0.0;  ///< travelled less true; positive: too far
};
/// Past the true contact by more than this, it went through.
inline constexpr double kTooFar_m = 0.02;
/// Judges how far a policy let the object move; a policy that found nothing to stop it gives limit_m.
Verdict judge(const Scenario& scenario, double travelled_m);

}  // namespace roomradar
