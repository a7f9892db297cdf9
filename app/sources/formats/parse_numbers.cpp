// parse_numbers.cpp: parses with std::from_chars, which is locale-independent.
#include "app/sources/formats/parse_numbers.hpp"

#include <charconv>
#include <cmath>
#include <limits>

#include "mapping/types/system/error.hpp"

namespace roomradar {

std::vector<std::string_view> split_words(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r\n";
  std::vector<std::string_view> words;
  for (std::size_t start = text.find_first_not_of(kBlank); start != std::string_view::npos;) {
    const std::size_t end = text.find_first_of(kBlank, start);
    words.push_back(text.substr(start, end == std::string_view::npos ? end : end - start));
    start = text.find_first_not_of(kBlank, end);
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

std::vector<double> parse_numbers(std::string_view text, const std::string& where) {
  std::vector<double> numbers;
  for (const std::string_view word : split_words(text)) {
    const auto number = parse_number(word);
    if (!number) throw Error(where + ": '" + std::string(word.substr(0, 40)) + "' is not a number");
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<std::int64_t> parse_whole_number(std::string_view word) {
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (fault != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

}  // namespace roomradar
