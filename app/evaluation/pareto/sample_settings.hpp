// sample_settings.hpp: draws the settings of a sweep at random.
#pragma once
#include <cstdint>
#include <vector>

#include "app/evaluation/pareto/parameter.hpp"

namespace roomradar {

/// Returns up to `count` different settings without the default, in random order; the same for the same seed.
///
/// Up to two thirds of the settings change a single parameter, to show its effect. If not all such changes
/// fit, faster values have priority because fronts consist of them, then values close to the default.
///
/// The others change all quality parameters at once. Each parameter's values occur about equally often, in
/// random combinations that tend to pair fast values with fast ones and slow with slow, since others are
/// rarely on a front. Every value of a quality parameter occurs if there are at least as many combinations as
/// values. Fewer settings are returned if not enough different ones are found.
std::vector<Setting> draw_settings(const std::vector<Parameter>& parameters, std::size_t count,
                                   std::uint64_t seed);

}  // namespace roomradar
