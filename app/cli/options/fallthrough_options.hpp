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

#include "radar/exact/radar_query.hpp"

namespace roomradar {

struct FallthroughOptions {
  // Options for a recorded room only.
  /// Recording of the room; empty: simulated rooms are used.
  std::string source;
  /// Folder of the room's map.
  std::string map;
  /// Folder of the map whose surface is the ground truth; empty: `map` is the ground truth.
  std::string reference;
  /// Origin of the frame's pose in the map: estimated or recorded.
  PoseOrigin poses = PoseOrigin::kAuto;
  /// Range of frames. Only its first frame is used. Unset: frame 0.
  std::optional<FrameRange> frames;
  /// Calibration file; empty: see calibration_for().
  std::string calibration;
  /// Radar that moves the objects.
  RadarMode radar = RadarMode::kExact;
  /// Side of the cells of the grid of drop positions.
  double cell_m = 0.1;
  /// PNG file with a plan of the room; empty: not written.
  std::string picture;

  // Options for simulated rooms only.
  /// Number of scenarios.
  int scenarios = 200;
  /// Seed of the scenarios.
  std::uint64_t seed = 1;
  /// Number of random rooms, in addition to room_names().
  int random_rooms = 3;
  /// Number of threads; 0: one per processor.
  int threads = 0;
  /// If set, only the scenarios of this range are run; unset: the first `scenarios`.
  std::optional<FrameRange> part;
  /// JSON file for the results of each scenario; empty: not written.
  std::string rows;
  /// Folder of the jobs that run the scenarios; empty: this process runs them.
  std::string jobs;
  /// Number of scenarios per job.
  int job_size = 100;
  /// Number of concurrent jobs; 0: one per processor.
  int processes = 0;
  /// Number of the single scenario to run; unset: all scenarios are run.
  std::optional<std::int64_t> scenario;
  /// Video file of the single scenario; used with `scenario`.
  std::string video;
  /// Folder in which the rooms' maps are stored and reused.
  std::string maps;
  /// CSV file with one line per scenario and policy; empty: not written.
  std::string csv;
  /// HTML file for tables, plots and images; empty: not written.
  std::string html;

  /// JSON file to write; empty: not written.
  std::string report;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, FallthroughOptions& options);

/// Checks combinations of options. Call after parsing. Throws CLI::ParseError for wrong usage.
void complete_options(const CLI::App& command, FallthroughOptions& options);

}  // namespace roomradar
