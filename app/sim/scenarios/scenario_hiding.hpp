// scenario_hiding.hpp: tests which room surfaces the prescan observed, and places occluders that hide them.
#pragma once
#include <optional>
#include <vector>

#include "app/sim/scenarios/scenario.hpp"
#include "app/sim/solids/counter_random.hpp"

namespace roomradar {

/// Surfaces that could stop the object are hidden from the camera up to this distance behind the true
/// contact.
inline constexpr double kBeyond_m = 0.05;

/// A surface point and its unit normal.
struct Patch {
  Eigen::Vector3d point_world, normal_world;
};

/// Returns a random unit vector.
Eigen::Vector3d random_unit(CounterRandom& random);

/// Returns the surface point at a random pixel of a random prescan frame, or nothing if the pixel's ray hits
/// nothing.
std::optional<Patch> draw_patch(const ScenarioRoom& from, CounterRandom& random);

/// Returns true if at least three prescan views observed the patch, unoccluded, at 0.6 to 3.5 m and not at a
/// grazing angle.
bool was_seen(const ScenarioRoom& from, const Patch& patch);

/// Returns true if the prescan observed the space that the object sweeps from its start to the true contact:
/// at least three views observed each of several hundred sample points. The object then never enters unknown
/// space.
bool way_was_seen(const ScenarioRoom& from, const Scenario& scenario);

/// Returns the points of the room that could stop the object within the limit. They are found by casting
/// several hundred rays from the object's front.
std::vector<Patch> stopping_patches(const Room& room, const Scenario& scenario, double limit_m);

/// Draws a camera pose, an occluder and its motion for a placed object until the points that could stop the
/// object are hidden.
/// @param patches  points that could stop the object
/// @return false if 12 draws fail
bool hide(const ScenarioRoom& from, const std::vector<Patch>& patches, CounterRandom& random,
          Scenario& scenario);

}  // namespace roomradar
