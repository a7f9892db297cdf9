// angles.hpp: the angle of a full rotation.
#pragma once
#include <numbers>

namespace roomradar {

inline constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;

}  // namespace roomradar
