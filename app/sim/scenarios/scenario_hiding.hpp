// scenario_hiding.hpp: tests whether the prescan observed room surfaces, and places occluders that hide them.
#pragma once
#include <optional>
#include <vector>

#include "app/sim/scenarios/scenario.hpp"
#include "mapping/types/system/counter_random.hpp"

namespace roomradar {

/// Occluders hide all surfaces that could stop the object up to this distance beyond the true contact.
inline constexpr double kBeyond_m = 0.05;

/// A surface point and its unit normal.
struct Patch {
  Eigen::Vector3d point_world, normal_world;
};

/// Returns a random unit vector.
Eigen::Vector3d random_unit(CounterRandom& random);

/// Returns the surface point at a random pixel of a random prescan frame, or nullopt if the pixel's ray hits
/// no surface.
std::optional<Patch> draw_patch(const ScenarioRoom& from, CounterRandom& random);

/// Returns true if at least three prescan views observed the patch without occlusion, at 0.6 to 3.5 m and not
/// at a grazing angle.
bool was_seen(const ScenarioRoom& from, const Patch& patch);

/// Returns true if the object enters no unknown space between its start and the true contact. Tests the swept
/// volume at several hundred sample points, each of which at least three prescan views must have observed.
bool way_was_seen(const ScenarioRoom& from, const Scenario& scenario);

/// Returns the room's surface points that could stop the object within limit_m. They are found by casting
/// several hundred rays from the object's front.
std::vector<Patch> stopping_patches(const Room& room, const Scenario& scenario, double limit_m);

/// Draws camera pose, occluder and occluder motion at random until the occluder hides `patches` from the
/// camera.
/// @param patches  surface points that could stop the object
/// @return false if 12 draws have failed
bool hide(const ScenarioRoom& from, const std::vector<Patch>& patches, CounterRandom& random,
          Scenario& scenario);

}  // namespace roomradar
