// recording_options.cpp: option names, help texts and checks of `roomradar check`, `record`, `simulate` and
// `calibrate`.
#include "app/cli/options/recording_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {

void add_options(CLI::App& command, RecordOptions& options) {
  add_source_argument(command, options.source);
  command.add_option("DIR", options.folder, "folder to write; must be empty or not exist (required)")
      ->required();
  add_frames_option(command, options.frames);
  add_calibration_option(command, options.calibration);
  add_input_options(command, options.input);
  add_format_option(command, options.format);
}

void add_options(CLI::App& command, SimulateOptions& options) {
  command.add_option("DIR", options.folder, "folder to write; must be empty or not exist (required)")
      ->required();
  command
      .add_option(
          "--room", options.room,
          "table, shelf, wall, random, flat, building or board, also with keys as after sim:, such as\n"
          "'building?rooms=40&width=320' (default: table)")
      ->type_name("NAME");
  command
      .add_option(
          "--seed", options.seed,
          "seed of the camera's path, the noise and the furniture of a random room, flat or building\n"
          "(default: 1)")
      ->type_name("N");
  command
      .add_option("--frames", options.frames,
                  "number of frames (default: 300; of the building its whole walk)")
      ->check(whole_within(1, 1'000'000))
      ->type_name("N");
  command
      .add_option(
          "--path", options.path,
          "camera path: scan (round the room), view (looking at its focus) or swing (in front of the\n"
          "board) (default: scan)")
      ->type_name("KIND");
  command
      .add_option("--moving", options.moving,
                  "moving things, separated by commas: hand, ball, person (default: none)")
      ->type_name("LIST");
  add_range_option(command, "--walks", options.walks,
                   "walks A to B of the building, inclusive, each in a folder DIR/walk-NNNN, and their list\n"
                   "DIR/recordings.txt (default: one recording)");
  add_format_option(command, options.format);
}

void add_options(CLI::App& command, CheckOptions& options) {
  command.add_option("RECORDING", options.recording, "folder or file of a recording (required)")->required();
  command.add_flag("--json", options.json, "print all of it as JSON, for other programs (default: off)");
  add_input_options(command, options.input);
}

void add_options(CLI::App& command, CalibrateOptions& options) {
  add_source_argument(command, options.source);
  command
      .add_option("--out", options.calibration,
                  "file to write, for --calibration of other commands (required)")
      ->required()
      ->type_name("FILE");
  command
      .add_option("--columns", options.board.columns,
                  with_default("inner corners along the board's longer side", options.board.columns))
      ->check(whole_within(3, 30))
      ->type_name("N");
  command
      .add_option("--rows", options.board.rows,
                  with_default("inner corners along the shorter side", options.board.rows))
      ->check(whole_within(3, 30))
      ->type_name("N");
  command
      .add_option("--square", options.board.square_m,
                  with_default("side of a square, metres", options.board.square_m))
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
