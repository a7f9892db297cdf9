// machine.hpp: describes the machine on which a measurement is made.
#pragma once
#include <string>

namespace roomradar {

struct Machine {
  std::string processor;  ///< model name; "unknown processor" if not available
  unsigned threads = 0;
  std::string system;    ///< "Linux 6.1"
  std::string renderer;  ///< name of the OpenGL renderer
};

/// Describes this machine. Queries the renderer in a child process, so this process stays without a GL
/// context. Throws Error if there is no renderer.
Machine this_machine();

}  // namespace roomradar
