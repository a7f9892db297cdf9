// infinity.hpp: short name for the infinity of a number type. It stands for "no distance limit" or "nothing
// found".
#pragma once
#include <limits>

namespace roomradar {

template <typename Number>
inline constexpr Number kInfinity = std::numeric_limits<Number>::infinity();

}  // namespace roomradar
