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
  // Options for a recorded room only.
  /// Recording of the room; empty: simulated rooms are used.
  std::string source;
  /// Folder of the room's map.
  std::string map;
  /// Folder of the map whose surface is the ground truth; empty: the same as `map`.
  std::string reference;
  /// Origin of the frame's pose in the map: estimated, or the recording's.
  PoseOrigin poses = PoseOrigin::kTracked;
  /// Range whose first frame is used; unset: frame 0.
  std::optional<FrameRange> frames;
  /// Calibration file with the cameras and their errors; empty: the source decides (see open_source()).
  std::string calibration;
  /// Side of the cells of the grid of drop positions.
  double cell_m = 0.1;
  /// PNG file with a plan of the room; empty: not written.
  std::string picture;

  // Options for simulated rooms only.
  /// Number of scenarios.
  int scenarios = 200;
  /// Seed of the scenarios.
  std::uint64_t seed = 1;
  /// Number of random rooms, in addition to the named ones.
  int random_rooms = 3;
  /// Number of threads; 0: one per processor.
  int threads = 0;
  /// Number of the only scenario to run and to show as a video; unset: all scenarios.
  std::optional<std::int64_t> scenario;
  /// Video file to write; used with `scenario`.
  std::string video;
  /// Folder in which the rooms' maps are stored and reused.
  std::string maps;
  /// CSV file with a line per scenario and policy; empty: not written.
  std::string csv;
  /// HTML file for tables, plots and images; empty: not written.
  std::string html;

  /// JSON file to write; empty: not written.
  std::string report;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, FallthroughOptions& options);

/// Checks the options against each other; call after parsing. Throws CLI::ParseError for wrong usage.
void complete_options(const CLI::App& command, FallthroughOptions& options);

}  // namespace roomradar
