// parse_numbers.hpp: locale-independent parsing of words and numbers in text files.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace roomradar {

/// Splits `line` at blanks, tabs and carriage returns.
std::vector<std::string_view> split_words(std::string_view line);

/// Parses all of `word` as a number, or returns nothing. NaN and infinities are accepted, in C's and in
/// Microsoft's spelling (nan, inf, `-1.#IND`, `1.#QNAN`, `1.#INF`).
std::optional<double> parse_number(std::string_view word);

/// Parses all of `word` as a whole number, or returns nothing.
std::optional<std::int64_t> parse_whole_number(std::string_view word);

}  // namespace roomradar
