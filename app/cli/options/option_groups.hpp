// option_groups.hpp: the help's groups of options, everyday options first, and its examples.
#pragma once

namespace CLI {
class App;
}

namespace roomradar {

/// Sorts the options of all commands into the help's groups, and adds examples. Options that no group lists
/// come last, under "Other". Call after all commands were added.
void arrange_help(CLI::App& app);

}  // namespace roomradar
