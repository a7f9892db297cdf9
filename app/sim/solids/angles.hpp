// angles.hpp: angle constants.
#pragma once
#include <numbers>

namespace roomradar {

inline constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;

}  // namespace roomradar
