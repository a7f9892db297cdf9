// farm_options.hpp: options of `roomradar farm`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "app/farm/batch_script.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct FarmOptions {
  /// File that lists the jobs; see read_manifest().
  std::string manifest;
  /// Folder of the results.
  std::string out;
  /// Number of concurrent jobs; 0: one per processor.
  int processes = 0;
  /// Names of the jobs to run, with the jobs that they need; empty: all.
  std::vector<std::string> jobs;
  /// Script to print instead of running the jobs; unset: the jobs are run.
  std::optional<BatchForm> emit;
  /// JSON file to write; empty: not written.
  std::string report;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, FarmOptions& options);

}  // namespace roomradar
