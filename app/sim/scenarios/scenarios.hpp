// scenarios.hpp: test cases of objects dropped or pushed onto surfaces hidden now but seen in the prescan.
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

/// Object that hides the surface on which the drop or push should end.
enum class Occluder {
  kFurniture,  ///< the room's own furniture, from the camera's present pose
  kBox,        ///< a box carried between the camera and the surface
  kHand,       ///< a hand and arm, moving in every other scenario of this kind
  kPerson,     ///< a person standing between
};
std::string_view to_string(Occluder occluder);

/// Length of a walk once around a room.
inline constexpr std::int64_t kScenarioPrescanFrames = 720;

/// A room with its prescan path, shared by all its scenarios, so one map per room suffices.
struct ScenarioRoom {
  Room room;
  SimOptions prescan;  ///< the frames to map the room from, without moving objects
  std::vector<Eigen::Isometry3d> T_world_prescan;  ///< every tenth prescan pose
};
/// @param seed  selects the camera's path, and the furniture if the room is `random`
/// Throws Error if there is no such room.
ScenarioRoom make_scenario_room(std::string_view name, std::uint64_t seed = 1);

/// Time between two frames of the camera.
inline constexpr double kScenarioFrame_s = 1.0 / 30.0;

/// An object that moves in a straight line until contact.
struct Scenario {
  std::uint64_t seed = 0;
  std::int64_t number = 0;
  std::string room;
  Occluder occluder = Occluder::kFurniture;
  std::vector<Solid> occluder_solids;  ///< not in the prescan; poses at frame 0
  std::vector<Material> occluder_materials;
  Eigen::Vector3d occluder_velocity_world = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();   ///< while the object moves
  /// Camera pose estimated by tracking, off by some millimetres and tenths of a degree.
  Eigen::Isometry3d T_world_believed = Eigen::Isometry3d::Identity();
  Intrinsics depth_camera = kKinectDepthCamera;

  ScenarioObject object;
  Mesh object_mesh;
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();  ///< start pose, collision free
  Eigen::Vector3d direction_world = -Eigen::Vector3d::UnitZ();       ///< unit
  double speed_m_s = 0.0;
  double limit_m = 0.0;        ///< travel without contact: 0.4 m beyond the true contact
  double true_travel_m = 0.0;  ///< distance to the first contact with the room
  Eigen::Vector3d contact_world = Eigen::Vector3d::Zero();  ///< point of that contact
};

/// Returns the object's travel per frame, m; up to 33 cm.
inline double step_m(const Scenario& scenario) { return scenario.speed_m_s * kScenarioFrame_s; }
/// Returns the last frame before contact: the frame at the start of the step in which the object reaches the
/// true surface.
inline int contact_frame(const Scenario& scenario) {
  return static_cast<int>(scenario.true_travel_m / step_m(scenario));
}
/// Returns the occluder's solids at the time of frame `frame`.
std::vector<Solid> occluder_at(const Scenario& scenario, int frame);

/// Makes scenario `number` of a seed; depends on nothing else. Guarantees:
/// - Every room point that could stop the object, up to 5 cm behind the true contact, is hidden from the
///   camera in the contact frame. The contact projects into the image.
/// - Each of those points was seen by at least three of T_world_prescan, from 0.6 to 3.5 m and not grazing.
/// - The space on the object's path was seen too: the object never enters unknown space.
/// - The object starts at least 2 cm from the room, and its path keeps 4 cm from the occluder.
/// - Shifted 5 mm sideways in any of four directions, the object would travel at most 15 mm more or less.
///   Contacts that depend on detail finer than the map's cells are excluded.
///
/// Four drops alternate with four pushes; the four occluder kinds take turns within each four, and object
/// shapes take turns too. An occluder hides at least half of the stopping surface by itself. If some thousand
/// draws find no placement in a room, the next occluder kind is tried, then the next shape. Throws Error if
/// all fail.
Scenario make_scenario(const ScenarioRoom& room, std::uint64_t seed, std::int64_t number);

/// Renders the camera's depth frame of room and occluder, without colour.
/// @param noise_scale  as in SimOptions; 0: exact
void render_scenario(const Scenario& scenario, const Room& room, int frame_number, double noise_scale,
                     Frame& frame);

enum class Outcome {
  kStoppedRight,
  kPassedThrough,  ///< more than 2 cm beyond the true contact
  kStoppedFalse,   ///< more than 3 cm short of the true contact
};
std::string_view to_string(Outcome outcome);
struct Verdict {
  Outcome outcome = Outcome::kStoppedRight;
  double error_m = 0.0;  ///< travelled minus true distance; positive: too far
};
/// Travel beyond the true contact by more than this counts as passing through.
inline constexpr double kTooFar_m = 0.02;
/// Judges the distance that a policy let the object travel; a policy that found no contact passes limit_m.
Verdict judge(const Scenario& scenario, double travelled_m);

}  // namespace roomradar
