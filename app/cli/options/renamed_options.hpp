// renamed_options.hpp: former names of options, which are accepted for one version after a rename.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

/// Adds a hidden option with the former name of an option that takes one value. When the hidden option is
/// used, prints the new name to stderr and passes the value to the option `name`, which checks it.
///
/// Call before adding `name`: CLI11 processes options in the order in which they were added.
void add_old_name(CLI::App& command, const std::string& old_name, const std::string& name);

/// Adds a hidden flag with the former name of a flag, as add_old_name() does.
void add_old_flag(CLI::App& command, const std::string& old_name, const std::string& name);

}  // namespace roomradar
