// record_options.hpp: options of `roomradar record`.
#pragma once
#include <optional>
#include <string>

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
  /// Format of the recording.
  RecordingFormat format = RecordingFormat::kTum;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, RecordOptions& options);

}  // namespace roomradar
