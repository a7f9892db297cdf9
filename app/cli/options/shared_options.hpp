// shared_options.hpp: options that several commands have in common.
#pragma once
#include <optional>
#include <string>

#include "app/sources/formats/frame_range.hpp"
#include "app/sources/recordings/recording_writer.hpp"
#include "mapping/types/pose_origin.hpp"

namespace CLI {
class App;
}

namespace roomradar {

// Each function adds one option to a command. The value must outlive the parsing.

/// Adds the required argument SOURCE.
/// @param more  text that precedes the general help on sources
void add_source_argument(CLI::App& command, std::string& source, const std::string& more = {});

/// Adds --poses. The default value is appended to `help`.
void add_poses_option(CLI::App& command, PoseOrigin& poses, const std::string& help);

/// Adds an option for a range A:B of numbers, both inclusive.
void add_range_option(CLI::App& command, const std::string& name, std::optional<FrameRange>& range,
                      const std::string& help);
void add_frames_option(CLI::App& command, std::optional<FrameRange>& frames);
void add_calibration_option(CLI::App& command, std::string& calibration);
void add_format_option(CLI::App& command, RecordingFormat& format);
void add_ui_scale_option(CLI::App& command, std::optional<double>& ui_scale);
/// Adds --processes, the number of concurrent jobs.
void add_processes_option(CLI::App& command, int& processes);
void add_report_option(CLI::App& command, std::string& report);

}  // namespace roomradar
