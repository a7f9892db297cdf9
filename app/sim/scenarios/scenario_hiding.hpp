// scenario_hiding.hpp: which of a room's surface was seen before, and what hides it from a camera now.
#pragma once
#include <optional>
#include <vector>

#include "app/sim/scenarios/scenarios.hpp"
#include "app/sim/solids/counter_random.hpp"

namespace roomradar {

/// What could stop the object this far behind the true contact must be hidden too.
inline constexpr double kBeyond_m = 0.05;

/// A surface point and its normal.
struct Patch {
  Eigen::Vector3d point_world, normal_world;
};

Eigen::Vector3d random_unit(CounterRandom& random);

/// The surface point that some pixel of some prescan frame saw.
std::optional<Patch> draw_patch(const ScenarioRoom& from, CounterRandom& random);

/// Whether three of the prescan's views have it, from 0.6 to 3.5 m, not grazing and with nothing between.
bool was_seen(const ScenarioRoom& from, const Patch& patch);

/// Whether three of the prescan's views saw through each of some hundred points of the space that the object
/// takes from its start to the true contact: there is nothing that nobody has seen in its way.
bool way_was_seen(const ScenarioRoom& from, const Scenario& scenario);

/// Room points that the object's front runs into within the limit, one for each of some hundred points of it.
std::vector<Patch> stopping_patches(const Room& room, const Scenario& scenario, double limit_m);

/// Draws cameras, occluders and how the occluder moves for a placed object, until its stopping surface is
/// hidden. False if that does not come about within a dozen draws.
bool hide(const ScenarioRoom& from, const std::vector<Patch>& patches, CounterRandom& random,
          Scenario& scenario);

}  // namespace roomradar
