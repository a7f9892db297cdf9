// sample_settings.hpp: selects the settings of a sweep at random.
#pragma once
#include <cstdint>
#include <vector>

#include "app/evaluation/pareto/parameter.hpp"

namespace roomradar {

/// Returns up to `count` different settings other than the default, in random order. The seed determines the
/// result.
///
/// Up to two thirds of the settings change a single parameter, to show its effect. If there are more such
/// changes, faster values of quality parameters come first, since fronts consist mostly of them. Among these
/// and among the others, values close to the default come first.
///
/// The other settings (combinations) change all quality parameters. The values of each parameter occur about
/// equally often. Combinations tend to pair fast values with fast ones and slow values with slow ones, since
/// mixed combinations are rarely on a front. Each value of a quality parameter occurs if there are at least
/// as many combinations as values. Fewer settings are returned if not enough different ones are found.
std::vector<Setting> draw_settings(const std::vector<Parameter>& parameters, std::size_t count,
                                   std::uint64_t seed);

}  // namespace roomradar
