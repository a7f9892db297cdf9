// infinity.hpp: the distance to nothing.
#pragma once
#include <limits>

namespace roomradar {

template <typename Number>
inline constexpr Number kInfinity = std::numeric_limits<Number>::infinity();

}  // namespace roomradar
