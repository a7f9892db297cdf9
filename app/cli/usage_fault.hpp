// usage_fault.hpp: says what is wrong with a command line, and what was probably meant.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace roomradar {

/// Returns the candidate that a misspelt word probably means: the only one that begins with the word, or the
/// one with the fewest letters inserted, left out, replaced or swapped, at most a third of them. Returns an
/// empty string if there is none. Source: Damerau, A technique for computer detection and correction of
/// spelling errors, CACM 1964 (distance with adjacent swaps only).
std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// Returns the message for a command line that could not be parsed: an unknown command or option with the
/// nearest known one, a missing argument with its meaning, else the parser's own sentence. Ends with a line
/// that names the help.
/// @param arguments  words of the command line without the program's name
std::string usage_fault(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments);

/// Returns a line per command of `app`, or per part of a command: its name and what it does.
std::string command_list(const CLI::App& app);

}  // namespace roomradar
