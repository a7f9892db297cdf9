// median.hpp: the middle one of some numbers.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace roomradar {

/// Of an even number the upper of the two in the middle. There must be at least one, and no NaN.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace roomradar
