// check_options.cpp: option names, help texts and checks of `roomradar check`.
#include "app/cli/options/check_options.hpp"

#include <CLI/CLI.hpp>

namespace roomradar {

void add_options(CLI::App& command, CheckOptions& options) {
  command.add_option("RECORDING", options.recording, "folder or file of a recording (required)")->required();
  command.add_flag("--json", options.json, "print all of it as JSON, for other programs (default: off)");
  add_input_options(command, options.input);
}

}  // namespace roomradar
