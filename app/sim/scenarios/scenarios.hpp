// scenarios.hpp: test cases: an object moves in a straight line towards a surface that an occluder hides from
// the camera.
#pragma once
#include <Eigen/Geometry>
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

/// Kind of object that hides the surface at which the object should stop.
enum class Occluder {
  /// The room's furniture.
  kFurniture,
  /// A box carried between the camera and the surface.
  kBox,
  /// A hand and forearm. They move in every second scenario of this kind.
  kHand,
  /// A person standing between the camera and the surface.
  kPerson,
};
std::string_view to_string(Occluder occluder);

/// Number of prescan frames of a room: one loop of the camera path.
inline constexpr std::int64_t kScenarioPrescanFrames = 720;

/// A room with the camera path of its prescan, the scan from which its map is made. All scenarios of a room
/// share the path. One map per room thus suffices.
struct ScenarioRoom {
  Room room;
  /// Options of the SimulatedSource that produces the prescan frames, without moving objects.
  SimOptions prescan;
  /// Camera poses of every tenth prescan frame.
  std::vector<Eigen::Isometry3d> T_world_prescan;
};
/// Time between two camera frames.
inline constexpr double kScenarioFrame_s = 1.0 / 30.0;

/// A test case.
struct Scenario {
  std::uint64_t seed = 0;
  std::int64_t number = 0;
  std::string room;
  Occluder occluder = Occluder::kFurniture;
  /// Solids of the occluder at frame 0. The prescan does not contain them.
  std::vector<Solid> occluder_solids;
  /// Materials of the occluder, one per solid.
  std::vector<Material> occluder_materials;
  /// Velocity of the occluder, m/s.
  Eigen::Vector3d occluder_velocity_world = Eigen::Vector3d::Zero();
  /// True camera pose while the object moves.
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  /// Simulated estimate of the camera pose. It is the true pose plus random errors with standard deviations
  /// of 1.5 mm and 0.1 degrees.
  Eigen::Isometry3d T_world_believed = Eigen::Isometry3d::Identity();
  Intrinsics depth_camera = kKinectDepthCamera;

  ScenarioObject object;
  Mesh object_mesh;
  /// Start pose of the object, free of collisions.
  Eigen::Isometry3d T_world_object = Eigen::Isometry3d::Identity();
  /// Unit direction of motion.
  Eigen::Vector3d direction_world = -Eigen::Vector3d::UnitZ();
  double speed_m_s = 0.0;
  /// Distance at which an object without contact stops, 0.4 m beyond the true contact.
  double limit_m = 0.0;
  /// True distance to the first contact with the room.
  double true_travel_m = 0.0;
  /// Point of the true contact.
  Eigen::Vector3d contact_world = Eigen::Vector3d::Zero();
};

/// Returns the distance that the object travels per frame, m; at most 0.33.
inline double step_m(const Scenario& scenario) { return scenario.speed_m_s * kScenarioFrame_s; }
/// Returns the last frame before the contact. The object touches the true surface between this frame and the
/// next.
inline int contact_frame(const Scenario& scenario) {
  return static_cast<int>(scenario.true_travel_m / step_m(scenario));
}

/// Returns the occluder's solids at the time of frame `frame`.
std::vector<Solid> occluder_at(const Scenario& scenario, int frame);

/// Renders the camera's depth frame of the room and the occluder, without colour.
/// @param noise_scale  factor on the Kinect's noise, see SimOptions::noise_scale; 0: exact depth
void render_scenario(const Scenario& scenario, const Room& room, int frame_number, double noise_scale,
                     Frame& frame);

/// Makes a room and plans its prescan.
/// @param seed  selects the camera's path, and the furniture if the room is `random`
/// @throws Error if there is no such room
ScenarioRoom make_scenario_room(std::string_view name, std::uint64_t seed = 1);

/// Makes scenario `number` of a seed. The result depends on room, seed and number only. Guarantees:
/// - In frame contact_frame(), all room points that could stop the object up to 5 cm beyond the true contact
///   are hidden from the camera. The contact point projects into the image.
/// - At least three cameras of T_world_prescan observed each of these points, at 0.6 to 3.5 m and not at a
///   grazing angle.
/// - The prescan observed the space that the object sweeps. The object thus never enters unknown space.
/// - The object starts at least 2 cm from the room's surfaces, and stays at least 4 cm from the occluder.
/// - A start 5 mm to the side, in any of four directions, would change the distance to contact by at most 15
///   mm. This excludes contacts that depend on detail finer than the map's voxels.
///
/// Scenarios alternate between four drops and four pushes. Each group of four contains all four kinds of
/// occluder. Successive scenarios also differ in the object's shape. Unless furniture is the occluder, the
/// room itself hides at most half of the points that could stop the object. If 3,000 random draws find no
/// placement, the next kind of occluder is tried, then the next shape. Throws Error if all fail.
Scenario make_scenario(const ScenarioRoom& room, std::uint64_t seed, std::int64_t number);

enum class Outcome {
  kStoppedRight,
  /// Stopped more than 2 cm beyond the true contact.
  kPassedThrough,
  /// Stopped more than 3 cm short of the true contact.
  kStoppedFalse,
};
std::string_view to_string(Outcome outcome);
struct Verdict {
  Outcome outcome = Outcome::kStoppedRight;
  /// Travelled distance minus true_travel_m, m; positive if the object moved too far.
  double error_m = 0.0;
};
/// Max distance beyond the true contact that does not count as passing through.
inline constexpr double kTooFar_m = 0.02;
/// Compares the distance that the object travelled with the true distance.
/// @param travelled_m  measured distance to contact; Scenario::limit_m if no contact was found
Verdict judge(const Scenario& scenario, double travelled_m);

}  // namespace roomradar
