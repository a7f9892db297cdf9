// parse_numbers.hpp: parses words and numbers of text files, independent of the locale.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace roomradar {

/// Splits `line` at spaces, tabs and carriage returns.
std::vector<std::string_view> split_words(std::string_view line);

/// Parses `word` as a number. Returns nullopt unless the whole word is a number. Accepts a leading plus sign,
/// and NaN and infinity in the spelling of C (nan, inf). Accepts Microsoft's spelling, too: words
/// that begin with `-1.#IND`, `1.#QNAN` or `1.#INF`, with or without a sign.
std::optional<double> parse_number(std::string_view word);

/// Parses `word` as an integer. Returns nullopt unless the whole word is an integer.
std::optional<std::int64_t> parse_whole_number(std::string_view word);

}  // namespace roomradar
