// option_checks.hpp: checks of option values that CLI11 lacks (ranges without "nan", named values, decimal
// integers).
#pragma once
#include <CLI/CLI.hpp>
#include <concepts>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "app/quality/quality.hpp"

namespace roomradar {

/// Returns a check that a number is in low..high. Unlike CLI11's Range, the check rejects "nan".
/// @param unit  unit in the plural, for the error message
CLI::Validator within(double low, double high, const std::string& unit);

/// Returns a check that a number is a whole number in low..high.
CLI::Validator whole_within(std::int64_t low, std::int64_t high);

/// Returns the help text with "(default: WORD)" at its end, on a new line if the last one has no room for it.
std::string with_default(const std::string& help, const std::string& word);
/// The same with a number, of which three digits are written.
std::string with_default(const std::string& help, double value);
template <std::integral Number>
std::string with_default(const std::string& help, Number value) {
  return with_default(help, std::to_string(value));
}

/// Throws CLI::ValidationError with the name and `why` if one of these options was given.
void refuse_given(const CLI::App& command, const std::vector<std::string>& names, const char* why);

/// Adds checks that reject numbers that CLI11 would misread. It reads 010 as 8, and the seed -1 as 2^64 - 1.
/// The checks apply to all options of type "N" of the program and its commands. Call after all options were
/// added.
void refuse_other_bases(CLI::App& app);

/// Rejects values of flags, such as --window=3, in the program and its commands. Call after all options were
/// added.
void refuse_flag_values(CLI::App& app);

/// Adds an option with a value that is one of several words. CLI11's transformer would list the values as
/// numbers.
/// @param value  the default; must outlive the parsing
/// @param choices  words, and the values that they set
/// @param help  the word of the default is appended, unless the text states a default
template <typename Value>
void add_choice(CLI::App& command, const std::string& name, Value& value,
                const std::map<std::string, Value>& choices, const std::string& help) {
  std::string type, whole_help = help;
  const bool states_default = help.find("(default: ") != std::string::npos;
  for (const auto& [word, meaning] : choices) {
    type += (type.empty() ? "" : "|") + word;
    if (!states_default && meaning == value) whole_help = with_default(help, word);
  }
  command
      .add_option_function<std::string>(
          name,
          [&value, choices, name, type](const std::string& word) {
            const auto found = choices.find(word);
            if (found == choices.end())
              throw CLI::ValidationError(name + " " + word + ": must be " + words_of_choice(type));
            value = found->second;
          },
          whole_help)
      ->type_name(type);
}

}  // namespace roomradar
