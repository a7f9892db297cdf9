// recording_options.hpp: options of the commands that write recordings: `roomradar record` and `roomradar
// simulate`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

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

}  // namespace roomradar
