// number_text.hpp: a number as text that reads back as the same number.
#pragma once
#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>

namespace roomradar {

/// The shortest such text, whatever the locale: "0.1", "-3", "1e-09", "nan".
template <typename Number>
std::string number_text(Number value) {
  std::array<char, 32> text;  // what a double needs at most is 24
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// With so many digits after the point (0..20), whatever the locale, as "%.6f" has it in the C locale.
inline std::string fixed_text(double value, int digits) {
  std::array<char, 340> text;  // the greatest double has 309 before it
  return {text.data(),
          std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, digits).ptr};
}

/// With so many digits that count (1..20), whatever the locale, as "%.6g" has it in the C locale.
inline std::string general_text(double value, int digits) {
  std::array<char, 40> text;
  return {
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::general, digits).ptr};
}

/// A frame's number in the names of files: six digits, more where it has more.
inline std::string frame_number_text(std::int64_t number) {
  std::string text = std::to_string(number);
  return text.insert(0, 6 - std::min<std::size_t>(text.size(), 6), '0');
}

}  // namespace roomradar
