// parse_numbers.hpp: parses words and numbers of text files, independent of the locale.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roomradar {

/// Splits `text` at spaces, tabs and line ends.
std::vector<std::string_view> split_words(std::string_view text);

/// Parses `word` as a number. Returns nullopt unless the whole word is a number. Accepts a leading plus sign,
/// and NaN and infinity in the spelling of C (nan, inf). Accepts Microsoft's spelling, too: words
/// that begin with `-1.#IND`, `1.#QNAN` or `1.#INF`, with or without a sign.
std::optional<double> parse_number(std::string_view word);

/// Returns the numbers of a text. Throws Error naming `where` and the first word that is no number.
std::vector<double> parse_numbers(std::string_view text, const std::string& where);

/// Parses `word` as an integer. Returns nullopt unless the whole word is an integer.
std::optional<std::int64_t> parse_whole_number(std::string_view word);

}  // namespace roomradar
