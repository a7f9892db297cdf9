// dynamic_bench_foreground.hpp: how right the foreground is, on simulated movers and where nothing moves.
#pragma once
#include <nlohmann/json.hpp>

namespace roomradar::test {

using Rows = nlohmann::json;  ///< an array of objects, one a measured cell

/// Appends masks of hand, ball and person against the truth; a hand at 1 to 20 cm over a table; what is
/// marked in recordings where nothing moves. A recording that is absent is said on stdout and has no row.
void measure_foreground(Rows& rows);

}  // namespace roomradar::test
