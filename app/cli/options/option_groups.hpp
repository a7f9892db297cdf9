// option_groups.hpp: groups of options in the help, with common options first, and examples.
#pragma once

#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace roomradar {

/// Assigns the options of all commands to groups, and adds examples to the help. Options without a group come
/// last, under "Other". Call after all commands were added.
void arrange_help(CLI::App& app);

/// Returns the visible options of a command, positionals first, in the order of the help.
std::vector<const CLI::Option*> options_in_order(const CLI::App& command);

}  // namespace roomradar
