// command_tree.hpp: the commands of the command line, and their subcommands, such as `map export`.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

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

}  // namespace roomradar
