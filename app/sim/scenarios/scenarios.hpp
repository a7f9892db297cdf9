// scenarios.hpp: makes and judges test cases of objects dropped or pushed onto surfaces that are hidden now
// but were observed in the prescan.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "app/sim/scenarios/scenario.hpp"
#include "app/sim/scenarios/scenario_frame.hpp"

namespace roomradar {

/// Makes a room and plans its prescan.
/// @param seed  selects the camera's path, and the furniture if the room is `random`
/// @throws Error if there is no such room
ScenarioRoom make_scenario_room(std::string_view name, std::uint64_t seed = 1);

/// Makes scenario `number` of a seed. The result depends on room, seed and number only. Guarantees:
/// - Every room point that could stop the object, up to 5 cm behind the true contact, is hidden from the
///   camera in the contact frame. The contact projects into the image.
/// - At least three of T_world_prescan observed each of those points, at 0.6 to 3.5 m and not at a grazing
///   angle.
/// - The prescan also observed the space on the object's path, so the object never enters unknown space.
/// - The object starts at least 2 cm from the room, and its path keeps 4 cm from the occluder.
/// - If the object started 5 mm to the side, in any of four directions, its distance to contact would change
///   by at most 15 mm. This excludes contacts that depend on detail finer than the map's cells.
///
/// Scenarios alternate between four drops and four pushes; each group of four has all four kinds of occluder.
/// Object shapes alternate too. The occluder alone hides at least half of the stopping points. If 3,000 draws
/// find no placement, the next kind of occluder is tried, then the next shape. Throws Error if all fail.
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
  /// Travelled distance minus true distance, m; positive if the object moved too far.
  double error_m = 0.0;
};
/// Max distance beyond the true contact that does not count as passing through.
inline constexpr double kTooFar_m = 0.02;
/// Judges the distance that the object travelled with the surfaces of a policy. If the policy found no
/// contact, travelled_m is limit_m.
Verdict judge(const Scenario& scenario, double travelled_m);

}  // namespace roomradar
