// parse_numbers.hpp: words and numbers out of text files, the same in every locale.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace roomradar {

/// The words of `line` between blanks, tabs and carriage returns.
std::vector<std::string_view> split_words(std::string_view line);

/// The number that all of `word` is, or nothing. NaN and infinities are numbers here, in C's and in
/// Microsoft's spelling (nan, inf, `-1.#IND`, `1.#QNAN`, `1.#INF`).
std::optional<double> parse_number(std::string_view word);

/// The whole number that all of `word` is, or nothing.
std::optional<std::int64_t> parse_whole_number(std::string_view word);

}  // namespace roomradar
