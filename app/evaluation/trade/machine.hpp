// machine.hpp: what a measurement was made on.
#pragma once
#include <string>

namespace roomradar {

struct Machine {
  std::string processor;  ///< "unknown processor" where the system does not say
  unsigned threads = 0;
  std::string system;    ///< "Linux 6.1"
  std::string renderer;  ///< of OpenGL
};

/// Asks for the renderer in a process of its own, so that this one stays without a GL context. Throws Error
/// if there is none.
Machine this_machine();

}  // namespace roomradar
