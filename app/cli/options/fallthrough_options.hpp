// fallthrough_options.hpp: options of `roomradar fallthrough`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "app/sources/formats/frame_range.hpp"
#include "mapping/types/pose_origin.hpp"

namespace CLI {
class App;
}

namespace roomradar {

struct FallthroughOptions {
  // Recorded room only:
  std::string source;     ///< recording of the room; empty: simulated rooms
  std::string map;        ///< folder of the room's map
  std::string reference;  ///< folder of the map whose surface is the ground truth; empty: `map` itself
  PoseOrigin poses = PoseOrigin::kTracked;  ///< origin of the frame's pose in the map
  std::optional<FrameRange> frames;         ///< the first frame of the range is used; unset: frame 0
  std::string calibration;  ///< file with the cameras and their errors; empty: as the source says
  double cell_m = 0.1;      ///< edge of the grid's cells
  std::string picture;      ///< PNG file with a plan of the room; empty: not written

  // Simulated rooms only:
  int scenarios = 200;                   ///< number of scenarios
  std::uint64_t seed = 1;                ///< seed of the scenarios
  int random_rooms = 3;                  ///< number of random rooms, in addition to the named ones
  int threads = 0;                       ///< 0: one per processor
  std::optional<std::int64_t> scenario;  ///< only this scenario, as a video
  std::string video;                     ///< file for `scenario`
  std::string maps;                      ///< folder in which the rooms' maps are stored and reused
  std::string csv;                       ///< file with a line per scenario and policy; empty: not written
  std::string html;                      ///< file for tables, plots and pictures; empty: not written

  std::string report;  ///< JSON file to write; empty: not written
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, FallthroughOptions& options);

/// Checks the options against each other; call after parsing. Throws CLI::ParseError for wrong usage.
void complete_options(const CLI::App& command, FallthroughOptions& options);

}  // namespace roomradar
