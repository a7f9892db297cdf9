// shared_options.cpp: options that several commands have, with one help text each.
#include "app/cli/options/shared_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cli/options/option_checks.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {

void add_source_argument(CLI::App& command, std::string& source, const std::string& more) {
  command
      .add_option("SOURCE", source,
                  "recording (a folder or file), kinect:N, openni:N or sim:ROOM" + more +
                      ";\n`roomradar help sources` explains them (required)")
      ->required();
}

void add_poses_option(CLI::App& command, PoseOrigin& poses, const std::string& help) {
  add_choice(
      command, "--poses", poses,
      {{"auto", PoseOrigin::kAuto}, {"tracked", PoseOrigin::kTracked}, {"recorded", PoseOrigin::kRecorded}},
      help);
}

void add_range_option(CLI::App& command, const std::string& name, std::optional<FrameRange>& range,
                      const std::string& help) {
  command
      .add_option_function<std::string>(
          name,
          [&range, name](const std::string& text) {
            try {
              range = parse_frame_range(text, name.substr(2));
            } catch (const Error& error) {
              throw CLI::ValidationError(error.what());
            }
          },
          help)
      ->type_name("A:B");
}

void add_frames_option(CLI::App& command, std::optional<FrameRange>& frames) {
  add_range_option(command, "--frames", frames,
                   "use only frames A to B, inclusive, counted from 0 (default: all)");
}

void add_calibration_option(CLI::App& command, std::string& calibration) {
  command
      .add_option("--calibration", calibration,
                  "cameras and their errors, as written by `roomradar calibrate`\n"
                  "(default: calibration.json in SOURCE, otherwise the cameras that SOURCE describes)")
      ->type_name("FILE");
}

void add_format_option(CLI::App& command, RecordingFormat& format) {
  add_choice(command, "--format", format,
             {{"tum", RecordingFormat::kTum},
              {"7scenes", RecordingFormat::kSevenScenes},
              {"fakenect", RecordingFormat::kFakenect},
              {"rosbag", RecordingFormat::kRosBag}},
             "format of the recording");
}

void add_ui_scale_option(CLI::App& command, std::optional<double>& ui_scale) {
  command
      .add_option("--ui-scale", ui_scale,
                  "scale of the window's text and panes, reduced in a window that is too small for it\n"
                  "(default: the monitor's)")
      ->check(within(0.5, 4.0, "times"))
      ->type_name("X");
}

void add_processes_option(CLI::App& command, int& processes) {
  command.add_option("--processes", processes, "jobs at a time (default: one per processor)")
      ->check(whole_within(1, 4096))
      ->type_name("N");
}

void add_report_option(CLI::App& command, std::string& report) {
  command
      .add_option("--report", report,
                  "write settings, times, memory and results as JSON (default: not written)")
      ->type_name("FILE");
}

}  // namespace roomradar
