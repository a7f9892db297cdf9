// dynamic_bench_foreground.hpp: accuracy of the foreground, on simulated movers and in recordings without
// motion.
#pragma once
#include <nlohmann/json.hpp>

namespace roomradar::test {

using Rows = nlohmann::json;  ///< an array of objects, one per measured cell

/// Appends rows: masks of hand, ball and person against the truth; a hand 1 to 20 cm above a table; pixels
/// marked in recordings without motion. For an absent recording, prints a message and appends no row.
void measure_foreground(Rows& rows);

}  // namespace roomradar::test
