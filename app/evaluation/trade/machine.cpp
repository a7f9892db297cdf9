// machine.cpp: reads /proc and queries the driver.
#include "app/evaluation/trade/machine.hpp"

#include <sys/utsname.h>

#include <fstream>
#include <thread>

#include "mapping/types/system/run_sandboxed.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {
namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown processor";
}

}  // namespace

Machine this_machine() {
  constexpr unsigned kMost_s = 60;
  constexpr std::size_t kMost_bytes = std::size_t{1} << 38U;
  Machine machine{
      .processor = processor(), .threads = std::thread::hardware_concurrency(), .system = {}, .renderer = {}};
  utsname system{};
  if (uname(&system) == 0) machine.system = std::string(system.sysname) + " " + system.release;
  machine.renderer = run_sandboxed([] { return GlContext().renderer(); }, "OpenGL does not say its renderer",
                                   kMost_s, kMost_bytes);
  return machine;
}

}  // namespace roomradar
