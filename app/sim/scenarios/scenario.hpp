// scenario.hpp: a test case: an object that moves towards a surface hidden by an occluder.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "app/sim/room/room.hpp"
#include "app/sim/scenarios/scenario_object.hpp"
#include "app/sim/sensor/sim_options.hpp"
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

}  // namespace roomradar
