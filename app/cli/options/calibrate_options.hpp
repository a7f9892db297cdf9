// calibrate_options.hpp: options of `roomradar calibrate`.
#pragma once
#include <optional>
#include <string>

#include "app/calibration/board_views.hpp"
#include "app/sources/formats/frame_range.hpp"

namespace CLI {
class App;
}

namespace roomradar {

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
