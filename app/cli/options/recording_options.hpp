// recording_options.hpp: options of the commands that read or write one recording: `roomradar check`,
// `record`, `simulate` and `calibrate`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "app/calibration/board_views.hpp"
#include "app/cli/options/input_options.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "app/sources/recordings/recording_writer.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct RecordOptions {
  /// Source of the frames, in the form that open_source() accepts.
  std::string source;
  /// Folder to write.
  std::string folder;
  /// Range of frames to record; unset: all.
  std::optional<FrameRange> frames;
  /// Calibration file; empty: see calibration_for().
  std::string calibration;
  /// What the user states about the recording.
  InputOptions input;
  RecordingFormat format = RecordingFormat::kTum;
};

struct SimulateOptions {
  /// Folder to write.
  std::string folder;
  /// Room in the syntax that follows `sim:`, with or without `?key=value` settings; see parse_sim_spec().
  std::string room = "table";
  /// Seed of the camera path, the phases of moving objects, the noise, and the furniture of a random room,
  /// flat or building; unset: see SimOptions.
  std::optional<std::uint64_t> seed;
  /// Number of frames; unset: see parse_sim_spec().
  std::optional<std::int64_t> frames;
  /// Name of the camera path: scan, view or swing; empty: see SimOptions.
  std::string path;
  /// Range of walks (camera trajectories through the building, see SimOptions::walk) to record, each in its
  /// own folder; unset: one recording.
  std::optional<FrameRange> walks;
  /// Moving objects, such as "hand,ball,person"; empty: none.
  std::string moving;
  RecordingFormat format = RecordingFormat::kTum;
};

/// Add the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, RecordOptions& options);
void add_options(CLI::App& command, SimulateOptions& options);

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

struct CalibrateOptions {
  /// Source of the frames, in the form that open_source() accepts.
  std::string source;
  /// Calibration file to write.
  std::string calibration;
  /// Checkerboard in the recording.
  Board board;
  /// Range of frames to use; unset: all.
  std::optional<FrameRange> frames;
  /// PNG file of calibration_plot(); empty: not written.
  std::string plot;
  /// JSON file to write; empty: not written.
  std::string report;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, CalibrateOptions& options);

}  // namespace roomradar
