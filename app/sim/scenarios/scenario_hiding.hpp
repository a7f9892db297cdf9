// scenario_hiding.hpp: visibility of room surfaces in the prescan, and placement of occluders in front of
// them.
#pragma once
#include <optional>
#include <vector>

#include "app/sim/scenarios/scenario.hpp"
#include "app/sim/solids/counter_random.hpp"

namespace roomradar {

/// Surfaces that could stop the object up to this far behind the true contact must be hidden too.
inline constexpr double kBeyond_m = 0.05;

/// A surface point and its normal.
struct Patch {
  Eigen::Vector3d point_world, normal_world;
};

Eigen::Vector3d random_unit(CounterRandom& random);

/// Returns the surface point seen by a random pixel of a random prescan frame; nothing if the ray hits
/// nothing.
std::optional<Patch> draw_patch(const ScenarioRoom& from, CounterRandom& random);

/// Returns true if three prescan views saw the patch, from 0.6 to 3.5 m, not grazing and unoccluded.
bool was_seen(const ScenarioRoom& from, const Patch& patch);

/// Returns true if the prescan observed the space that the object sweeps from its start to the true contact:
/// each of some hundred sample points was seen by three views. The object then never enters unknown space.
bool way_was_seen(const ScenarioRoom& from, const Scenario& scenario);

/// Returns the room points that the object's front hits within the limit, by casting some hundred rays from
/// it.
std::vector<Patch> stopping_patches(const Room& room, const Scenario& scenario, double limit_m);

/// Draws a camera, an occluder and its motion for a placed object until the surface that stops it is hidden.
/// Returns false if a dozen draws fail.
bool hide(const ScenarioRoom& from, const std::vector<Patch>& patches, CounterRandom& random,
          Scenario& scenario);

}  // namespace roomradar
