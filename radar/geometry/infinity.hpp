// infinity.hpp: short name for a number type's infinity, which stands for "no distance limit" or "nothing
// found".
#pragma once
#include <limits>

namespace roomradar {

template <typename Number>
inline constexpr Number kInfinity = std::numeric_limits<Number>::infinity();

}  // namespace roomradar
