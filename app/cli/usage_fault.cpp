// usage_fault.cpp: follows the words of the command line to the command they name, then to the wrong word.
#include "app/cli/usage_fault.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/cli/options/command_tree.hpp"

namespace roomradar {
namespace {

/// Edit distance with insertions, deletions, replacements and swaps of adjacent letters.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] =
          std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// Returns the candidate that the word probably means, see did_you_mean(); empty if there is none.
std::string nearest_word(std::string_view word, std::span<const std::string> candidates) {
  std::vector<std::string> longer;
  for (const std::string& candidate : candidates)
    if (word.size() >= 2 && candidate.starts_with(word) && candidate != "--" + std::string(word))
      longer.push_back(candidate);
  if (longer.size() == 1) return longer.front();
  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (const std::string& candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance >= least) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::string full_name(const CLI::App& app) {
  return app.get_parent() != nullptr ? full_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

/// Returns the first line of an option's help, without its default.
std::string meaning_of(const CLI::Option& option) {
  std::string text = option.get_description();
  for (const char* end : {"(default", "(required"}) text = text.substr(0, text.find(end));
  std::replace(text.begin(), text.end(), '\n', ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == ';')) text.pop_back();
  return text;
}

std::string missing_argument(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_required() || option->count() > 0) continue;
    const std::vector<std::string>& long_names = option->get_lnames();
    const std::string name = long_names.empty() ? option->get_name(true) : "--" + long_names.front();
    return name + " is missing: " + meaning_of(*option);
  }
  return {};
}

/// Returns a sentence about an option that is given twice or without a value, or a flag with one; empty for
/// other faults.
/// @param what  CLI11's message: "--map: At Most 1 required but received 2", "--map: 1 required DIR missing"
/// or "window was given a disallowed flag override"
std::string wrong_count(const CLI::App& command, const std::string& what) {
  const std::size_t flag_end = what.find(" was given a disallowed flag override");
  if (flag_end != std::string::npos) {
    const std::string flag = what.substr(0, flag_end);
    return (flag.starts_with("-") ? "" : "--") + flag + ": takes no value";
  }
  const std::string name = what.substr(0, what.find(':'));
  const CLI::Option* option = command.get_option_no_throw(name);
  if (option == nullptr) return {};
  if (what.find("At Most 1 required") != std::string::npos)
    return name + ": is given " + what.substr(what.rfind(' ') + 1) + " times; give it once";
  if (!what.ends_with(" missing")) return {};
  const std::string type = option->get_type_name();
  const std::string meaning = option->get_group().empty() ? "" : ", " + type + ": " + meaning_of(*option);
  return name + ": needs a value" + meaning;
}

std::string unknown_option(const CLI::App& command, std::span<const std::string> rest) {
  for (const std::string& word : rest) {
    if (word == "--") break;
    if (!word.starts_with("--")) continue;
    const std::string name = word.substr(0, word.find('='));
    if (command.get_option_no_throw(name) != nullptr) continue;
    return "there is no option " + name + did_you_mean(name, option_names(command));
  }
  return {};
}

/// Returns a line with name and description for each direct subcommand of `app`, the program or one of its
/// commands.
std::string command_list(const CLI::App& app) {
  std::string list;
  for (const CLI::App* command : commands_of(app)) {
    std::string what = command->get_description();
    what = what.substr(0, what.find_first_of(":;\n"));
    if (what.ends_with(',')) what.pop_back();
    const std::string& name = command->get_name();
    list += "  " + name + std::string(name.size() < 13 ? 13 - name.size() : 1, ' ') + what + "\n";
  }
  return list;
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  const std::string nearest = nearest_word(word, candidates);
  return nearest.empty() ? "" : "; did you mean " + nearest + "?";
}

std::string usage_fault(const CLI::App& app, const CLI::ParseError& error,
                        const std::vector<std::string>& arguments) {
  const CLI::App* command = &app;
  std::size_t at = 0;
  while (at < arguments.size() && !commands_of(*command).empty()) {
    const std::string& word = arguments[at];
    const CLI::App* part = command_named(*command, word);
    if (part == nullptr) break;
    command = part;
    ++at;
  }
  const std::string name = full_name(*command);
  const std::string see_help = "\n" + name + " --help lists " +
                               (commands_of(*command).empty() ? "all options" : "all commands") + "\n";
  const std::vector<const CLI::App*> parts = commands_of(*command);
  if (!parts.empty()) {
    std::vector<std::string> names;
    for (const CLI::App* part : parts) names.push_back(part->get_name());
    if (at < arguments.size() && arguments[at].starts_with("-")) {
      std::string fault = unknown_option(*command, std::span(arguments).subspan(at));
      if (!fault.empty()) return name + ": " + fault + see_help;
      const std::string what = error.what();  // it begins with a colon if the option is not in the help
      fault = wrong_count(*command, what.starts_with(':') ? arguments[at] + what : what);
      return name + ": " + (fault.empty() ? what : fault) + see_help;
    }
    if (at == arguments.size())
      return name + " needs a command:\n" + command_list(*command) + see_help.substr(1);
    const std::string hint = did_you_mean(arguments[at], names);
    return name + ": there is no command '" + arguments[at] + "'" +
           (hint.empty() ? "; the commands are\n" : hint + " The commands are\n") + command_list(*command) +
           see_help.substr(1);
  }
  std::string fault = unknown_option(*command, std::span(arguments).subspan(at));
  if (fault.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::RequiredError))
    fault = missing_argument(*command);
  if (fault.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError)) {
    const std::string what = error.what();
    fault = "more arguments than it takes" + what.substr(std::min(what.find(':'), what.size()));
  }
  if (fault.empty()) fault = wrong_count(*command, error.what());
  if (fault.empty()) fault = error.what();
  return name + ": " + fault + see_help;
}

}  // namespace roomradar
