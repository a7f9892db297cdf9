// record_options.cpp: option names and help texts of `roomradar record`.
#include "app/cli/options/record_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cli/options/shared_options.hpp"

namespace roomradar {

void add_options(CLI::App& command, RecordOptions& options) {
  add_source_argument(command, options.source);
  command.add_option("DIR", options.folder, "folder to write; must be empty or not exist (required)")
      ->required();
  add_frames_option(command, options.frames);
  add_calibration_option(command, options.calibration);
  add_format_option(command, options.format);
}

}  // namespace roomradar
