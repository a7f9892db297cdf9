// machine.hpp: description of the machine on which a measurement is made.
#pragma once
#include <string>

namespace roomradar {

struct Machine {
  std::string processor;  ///< model name; "unknown processor" if not available
  unsigned threads = 0;
  std::string system;    ///< such as "Linux 6.1"
  std::string renderer;  ///< name of the OpenGL renderer
};

/// Returns the description of this machine. A child process queries the renderer, so this process creates no
/// GL context. Throws Error if there is no renderer.
Machine this_machine();

}  // namespace roomradar
