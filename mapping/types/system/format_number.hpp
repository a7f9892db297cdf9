// format_number.hpp: locale-independent formatting of numbers, and rounding that never prints "-0.00".
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>

namespace roomradar {

/// Returns the shortest text that reads back as the same number, in any locale: "0.1", "-3", "1e-09", "nan".
template <typename Number>
std::string format_number(Number value) {
  std::array<char, 32> text;  // a double needs at most 24
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// Formats with `digits` (0..20) digits after the point, like "%.6f" in the C locale.
inline std::string format_fixed(double value, int digits) {
  std::array<char, 340> text;  // the largest double has 309 digits before the point
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, digits).ptr};
}

/// Returns the shortest text without exponent that reads back as the same number.
inline std::string format_exact(double value) {
  std::array<char, 360> text;  // the smallest double has 324 zeros after the point
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed).ptr};
}

/// Formats with `digits` (1..20) significant digits, like "%.6g" in the C locale.
inline std::string format_general(double value, int digits) {
  std::array<char, 40> text;
  return {
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr};
}

/// Formats for people: with `digits` (1..17) significant digits, but all digits before the point, and no
/// exponent from 0.0001 on: "0.35", "1040".
inline std::string format_readable(double value, int digits) {
  const std::string text = format_general(value, digits);
  return text.find("e+") == std::string::npos ? text : format_fixed(value, 0);
}

/// Returns a frame's number for file names: zero-padded to six digits, longer if needed.
inline std::string format_frame_number(std::int64_t number) {
  std::string text = std::to_string(number);
  return text.insert(0, 6 - std::min<std::size_t>(text.size(), 6), '0');
}

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
