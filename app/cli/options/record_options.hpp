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
  std::string source;                ///< as for open_source()
  std::string folder;                ///< folder to write
  std::optional<FrameRange> frames;  ///< unset: all
  std::string calibration;           ///< file with the cameras and their errors; empty: as the source says
  RecordingFormat format = RecordingFormat::kTum;  ///< format of the folder's files
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, RecordOptions& options);

}  // namespace roomradar
