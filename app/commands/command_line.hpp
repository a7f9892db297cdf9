// command_line.hpp: parses the command line.
#pragma once
#include <functional>

namespace roomradar {

struct ParsedCommand {
  std::function<int()> work;  ///< empty: help or a usage message was printed; exit with exit_status
  int exit_status = 0;        ///< 0 after help, 2 after wrong usage
};

/// Parses the arguments; prints help or a usage message itself. Throws Error if a presets file or a recorded
/// session named in them cannot be read.
ParsedCommand parse_command_line(int argc, const char* const* argv);

}  // namespace roomradar
