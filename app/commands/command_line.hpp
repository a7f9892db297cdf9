// command_line.hpp: parses the command line.
#pragma once
#include <functional>

namespace roomradar {

struct ParsedCommand {
  std::function<int()> work;  ///< the command; empty: help or a usage message was printed
  int exit_status = 0;        ///< if `work` is empty: 0 after help, 2 after wrong usage
};

/// Parses the arguments. Prints help or a usage message if needed. Throws Error if a presets file or a
/// recorded session named in the arguments cannot be read.
ParsedCommand parse_command_line(int argc, const char* const* argv);

}  // namespace roomradar
