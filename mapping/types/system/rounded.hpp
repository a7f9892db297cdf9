// rounded.hpp: numbers that never print as "-0.00".
#pragma once
#include <Eigen/Core>
#include <cmath>

namespace roomradar {

/// Returns the value; 0 for -0.
inline double without_minus_zero(double value) { return value + 0.0; }

/// Returns the value rounded to a number of decimals, 0 instead of -0.
inline double rounded(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  return without_minus_zero(std::round(scale * value) / scale);
}

inline Eigen::Vector3d rounded(const Eigen::Vector3d& value, int decimals) {
  return value.unaryExpr([decimals](double coordinate) { return rounded(coordinate, decimals); });
}

}  // namespace roomradar
