// bench_program.hpp: shared by the benchmarks: processor name, JSON output, error exit.
#pragma once
#include <algorithm>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string>

#include "mapping/types/system/error.hpp"

namespace roomradar::test {

/// Returns the name of this machine's processor.
inline std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(std::min(line.find(':') + 2, line.size()));
  return "unknown processor";
}

/// Writes the file of --json; does nothing if the path is empty. Throws Error if the file cannot be written.
template <typename Json>
void write_rows(const std::string& path, const Json& rows) {
  if (path.empty()) return;
  std::ofstream file(path);
  file << rows.dump(1) << "\n";
  if (!file.flush()) throw Error(path + ": cannot be written");
}

/// Returns the exit status of `run`; if `run` throws, prints the error and returns 1.
template <typename Run>
int run_or_say(const char* program, const Run& run) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", program, error.what());
    return 1;
  }
}

}  // namespace roomradar::test
