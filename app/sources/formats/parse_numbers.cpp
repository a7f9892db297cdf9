// parse_numbers.cpp: parses with std::from_chars, which is locale-independent.
#include "app/sources/formats/parse_numbers.hpp"

#include <charconv>
#include <cmath>
#include <limits>

namespace roomradar {

std::vector<std::string_view> split_words(std::string_view line) {
  constexpr std::string_view kBlank = " \t\r";
  std::vector<std::string_view> words;
  for (std::size_t start = line.find_first_not_of(kBlank); start != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(kBlank, start);
    words.push_back(line.substr(start, end == std::string_view::npos ? end : end - start));
    start = line.find_first_not_of(kBlank, end);
  }
  return words;
}

std::optional<double> parse_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  const std::string_view unsigned_word = word.substr(word.starts_with('-') ? 1 : 0);
  if (unsigned_word.starts_with("1.#IND") || unsigned_word.starts_with("1.#QNAN"))
    return std::numeric_limits<double>::quiet_NaN();
  if (unsigned_word.starts_with("1.#INF"))
    return std::copysign(std::numeric_limits<double>::infinity(), word.starts_with('-') ? -1.0 : 1.0);
  double value = 0.0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_whole_number(std::string_view word) {
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace roomradar
