// physics_bench_hands.hpp: a hand that sweeps through objects on a table, at speeds of 0.1 to 3 m/s.
#pragma once
#include <nlohmann/json.hpp>

namespace roomradar::bench {

/// Moves a hand through `objects` objects, one after the other, each in a session of its own with simulated
/// depth. Prints and appends one row per speed:
///   touched     objects that the hand moved or woke
///   entered     objects that the hand was in by 10 mm or more after a frame
///   unseen      entered objects, if another part of the hand was in front of that place in the camera's view
///               whenever the hand was in them
///   pinned      entered objects, if the room kept them from giving way whenever the hand was in them
///   passed      objects that ended behind the hand's path, or in the hand
///   deepest_mm  greatest depth of the hand in an object after a frame, in steps of 2.5 mm
void measure_hands(int objects, nlohmann::json& rows);

}  // namespace roomradar::bench
