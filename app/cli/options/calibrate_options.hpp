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
  std::string source;                ///< as for open_source()
  std::string calibration;           ///< file to write
  Board board;                       ///< checkerboard in the recording
  std::optional<FrameRange> frames;  ///< unset: all
  std::string plot;                  ///< PNG file to write; empty: not written
  std::string report;                ///< JSON file to write; empty: not written
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, CalibrateOptions& options);

}  // namespace roomradar
