// option_groups.hpp: groups of options in the help, with common options first, and examples.
#pragma once

namespace CLI {
class App;
}

namespace roomradar {

/// Assigns the options of all commands to groups, and adds examples to the help. Options without a group come
/// last, under "Other". Call after all commands were added.
void arrange_help(CLI::App& app);

}  // namespace roomradar
