// renamed_options.hpp: former names of options, which keep working for one version after a rename.
#pragma once
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

/// Adds the former name of an option that takes one value. The former name is hidden from the help and the
/// manual page. If it is used, prints the new name to stderr and passes the value to the option `name`, which
/// checks it.
///
/// Call before adding `name`: CLI11 processes options in the order in which they were added.
void add_old_name(CLI::App& command, const std::string& old_name, const std::string& name);

/// Adds the former name of a flag, in the same way.
void add_old_flag(CLI::App& command, const std::string& old_name, const std::string& name);

}  // namespace roomradar
