// command_tree.hpp: the commands of the command line, their subcommands, such as `map export`, and their
// options in the order of the help.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace roomradar {

/// Returns the commands of the program, or the subcommands of a command, without hidden ones.
inline std::vector<CLI::App*> commands_of(CLI::App& app) {
  return app.get_subcommands([](CLI::App* command) { return !command->get_group().empty(); });
}
inline std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

/// Returns the command or subcommand of that name; null if there is none.
template <typename App>
App* command_named(App& app, const std::string& name) {
  for (App* command : commands_of(app))
    if (command->check_name(name)) return command;
  return nullptr;
}

/// Assigns the options of all commands to groups, and adds examples to the help. Options without a group come
/// last, under "Other". Call after all commands were added.
void arrange_help(CLI::App& app);

/// Returns the visible options of a command, positionals first, in the order of the help.
std::vector<const CLI::Option*> options_in_order(const CLI::App& command);

}  // namespace roomradar
