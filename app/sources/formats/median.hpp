// median.hpp: median of a list of numbers.
#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace roomradar {

/// Returns the median. For an even number of values, returns the upper of the two middle ones. `values` must
/// not be empty or contain NaN.
inline double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace roomradar
