// renamed_options.hpp: former names of options, which work for one version after a rename.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

/// Adds the former name of an option with one value. It is hidden from the help and from the manual page,
/// prints the new name to stderr, and passes its value to the option `name`, which checks it.
///
/// Call before adding `name`: CLI11 processes options in the order in which they were added.
void add_old_name(CLI::App& command, const std::string& old_name, const std::string& name);

/// Adds the former name of a flag, in the same way.
void add_old_flag(CLI::App& command, const std::string& old_name, const std::string& name);

}  // namespace roomradar
