// calibrate_options.cpp: option names and help texts of `roomradar calibrate`.
#include "app/cli/options/calibrate_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {

void add_options(CLI::App& command, CalibrateOptions& options) {
  add_source_argument(command, options.source);
  command
      .add_option("--out", options.calibration,
                  "file to write, for --calibration of other commands (required)")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--columns", options.board.columns,
                  "inner corners along the board's longer side (default: 8)")
      ->check(whole_within(3, 30))
      ->type_name("N");
  command.add_option("--rows", options.board.rows, "inner corners along the shorter side (default: 6)")
      ->check(whole_within(3, 30))
      ->type_name("N");
  command.add_option("--square", options.board.square_m, "side of a square, metres (default: 0.03)")
      ->check(within(0.001, 1.0, "metres"))
      ->type_name("M");
  add_frames_option(command, options.frames);
  command
      .add_option("--plot", options.plot,
                  "draw the views of the board, and the errors before and after (default: not written)")
      ->type_name("FILE.png");
  add_report_option(command, options.report);
}

}  // namespace roomradar
