// number_text.hpp: a number as text that reads back as the same number.
#pragma once
#include <array>
#include <charconv>
#include <string>

namespace roomradar {

/// The shortest such text, whatever the locale: "0.1", "-3", "1e-09", "nan".
template <typename Number>
std::string number_text(Number value) {
  std::array<char, 32> text;  // what a double needs at most is 24
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

}  // namespace roomradar
