// option_checks.cpp: checks of ranges and of decimal numbers.
#include "app/cli/options/option_checks.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "mapping/types/system/classic_locale.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {

CLI::Validator within(double low, double high, const std::string& unit) {
  return CLI::Validator(
      [low, high, unit](const std::string& text) -> std::string {
        double value = 0.0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
        std::array<char, 80> rule{};
        format_classic(rule.data(), rule.size(), "must be between %.10g and %.10g", low, high);
        return std::string(rule.data()) + " (" + unit + "), not " + text;
      },
      "", "within");
}

CLI::Validator whole_within(std::int64_t low, std::int64_t high) {
  return CLI::Validator(
      [low, high](const std::string& text) -> std::string {
        std::int64_t value = 0;
        if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
        return "must be a whole number between " + std::to_string(low) + " and " + std::to_string(high) +
               ", not " + text;
      },
      "", "whole_within");
}

std::string with_default(const std::string& help, const std::string& word) {
  constexpr std::size_t kWidth = 100;
  const std::string note = "(default: " + word + ")";
  const std::size_t last_line = help.size() - (help.rfind('\n') + 1);  // npos + 1 is 0
  return help + (last_line + 1 + note.size() > kWidth ? "\n" : " ") + note;
}

std::string with_default(const std::string& help, double value) {
  return with_default(help, format_readable(value, 3));
}

void refuse_given(const CLI::App& command, const std::vector<std::string>& names, const char* why) {
  for (const std::string& name : names)
    if (command.count(name) > 0) throw CLI::ValidationError(name + why);
}

void refuse_other_bases(CLI::App& app) {
  const auto fault_of = [](const std::string& text) -> std::string {
    const bool is_plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (is_plain && (text.size() == 1 || !text.starts_with('0'))) return {};
    return "must be a whole number without leading zeros, not " + text;
  };
  for (CLI::Option* option : app.get_options())
    if (option->get_type_name() == "N") option->check(fault_of);
  for (CLI::App* command : app.get_subcommands({})) refuse_other_bases(*command);
}

void refuse_flag_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (option->get_items_expected_max() == 0) option->disable_flag_override();
  for (CLI::App* command : app.get_subcommands({})) refuse_flag_values(*command);
}

}  // namespace roomradar
