// scenarios.hpp: makes and judges test cases of objects dropped or pushed onto hidden surfaces. The prescan
// observed these surfaces, but an occluder now hides them from the camera.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "app/sim/scenarios/scenario.hpp"
#include "mapping/types/frame.hpp"

namespace roomradar {

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
