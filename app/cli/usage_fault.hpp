// usage_fault.hpp: error messages for a command line, with the probably intended word.
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

/// Returns "; did you mean X?" with the candidate X that a misspelt word probably means. X is the only
/// candidate that begins with `word`, or else the candidate with the smallest edit distance. The edit
/// distance counts insertions, deletions, substitutions and transpositions of adjacent letters; it may be at
/// most 1, or a third of the letters if that is more. Returns an empty string if there is no such candidate.
/// Source: Damerau, A technique for computer detection and correction of spelling errors, CACM 1964.
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);

/// Returns the message for a command line that could not be parsed. The message names an unknown command or
/// option and the nearest known one, a missing argument and its meaning, or an argument that is too many. For
/// other faults, it contains the parser's text. The last line names the command that shows the help.
/// @param arguments  words of the command line without the program's name
std::string usage_fault(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments);

}  // namespace roomradar
