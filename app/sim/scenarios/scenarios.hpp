// scenarios.hpp: test cases of objects dropped or pushed onto surfaces hidden now but seen in the prescan.
#pragma once
#include <cstdint>
#include <string_view>
#include <vector>

#include "app/sim/scenarios/scenario.hpp"
#include "app/sim/scenarios/scenario_frame.hpp"

namespace roomradar {

/// @param seed  selects the camera's path, and the furniture if the room is `random`
/// Throws Error if there is no such room.
ScenarioRoom make_scenario_room(std::string_view name, std::uint64_t seed = 1);

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
