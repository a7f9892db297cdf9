// prescan_options.hpp: options of `roomradar prescan`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "app/quality/quality.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "mapping/types/pose_origin.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct PrescanOptions {
  std::string source;                       ///< as for open_source()
  std::string map;                          ///< folder to write
  ScanQuality quality;                      ///< the preset's, with the fields of `fixed`
  FieldWords fixed;                         ///< settings given as options; no preset changes them
  std::string preset;                       ///< name; empty: none
  std::string presets;                      ///< file; empty: the program's own
  PoseOrigin poses = PoseOrigin::kTracked;  ///< estimated, or the recording's
  std::optional<FrameRange> frames;         ///< unset: all
  std::string calibration;          ///< file with the cameras and their errors; empty: as the source says
  std::int64_t hold_out = 0;        ///< N > 0: every Nth frame scores the map instead of being fused
  bool resume = false;              ///< continue an interrupted scan, or extend an existing map
  double checkpoint_every_s = 2.5;  ///< 0: no checkpoints
  double max_memory_mb = 0.0;       ///< memory cap of the process, 10^6 bytes; 0: no cap
  std::string report;               ///< JSON file to write; empty: not written
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, PrescanOptions& options);

/// Checks the options against each other and sets the quality; call after parsing. Throws CLI::ParseError
/// for wrong usage, and Error if the preset cannot be read.
void complete_options(const CLI::App& command, PrescanOptions& options);

}  // namespace roomradar
