// check_options.hpp: options of `roomradar check`.
#pragma once
#include <string>

#include "app/cli/options/input_options.hpp"

namespace roomradar {

struct CheckOptions {
  /// Recording, a folder or file.
  std::string recording;
  /// True: prints JSON.
  bool json = false;
  /// What the user states about the recording.
  InputOptions input;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, CheckOptions& options);

}  // namespace roomradar
