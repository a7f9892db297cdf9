// command_line.hpp: what the user typed, turned into work to do.
#pragma once
#include <functional>

namespace roomradar {

struct ParsedCommand {
  std::function<int()> work;  ///< empty: help or a usage message was printed; leave with exit_status
  int exit_status = 0;        ///< 0 after help, 2 after wrong usage
};

/// Prints help or a usage message itself. Throws Error if presets or a recorded session that it names
/// cannot be read.
ParsedCommand parse_command_line(int argc, const char* const* argv);

}  // namespace roomradar
