// measuring_options.hpp: options of `roomradar fallthrough`, `trade` and `farm`.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/farm/batch_script.hpp"
#include "app/sources/formats/frame_range.hpp"
#include "mapping/types/pose_origin.hpp"
#include "radar/exact/radar_query.hpp"

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

struct TradeOptions {
  /// Folders of recordings with poses, in addition to `rooms`.
  std::vector<std::string> recordings;
  /// Simulated rooms, as after `sim:`. Empty after complete_options() for the word "none".
  std::vector<std::string> rooms = {"table", "random?seed=2"};
  /// Command to measure, prescan or run; empty: both.
  std::string only;
  /// Number of randomly selected settings per command, in addition to the default.
  std::size_t settings = 30;
  /// Number of measurements per setting and scene.
  int repeats = 2;
  /// Seed for the selection of settings and for their order.
  std::uint64_t seed = 1;
  /// Kind of time by which settings are compared: wall or cpu.
  std::string time = "wall";
  /// Default number of virtual objects in a run.
  int objects = 1;
  /// True: uses few frames of small images.
  bool quick = false;
  /// True: only compares with table 1 of the Cyber Radar paper.
  bool compare_published = false;
  /// CSV file with one line per measurement; empty: not written.
  std::string csv;
  /// HTML file for plots and tables; empty: not written.
  std::string html;
  /// Presets file to write; empty: not written.
  std::string presets;
  /// JSON file to write; empty: not written.
  std::string report;

  /// Folder of the jobs that measure the settings; empty: this process measures them.
  std::string jobs;
  /// Number of concurrent jobs; 0: one per processor.
  int processes = 0;
  /// Single setting to measure, in the syntax of setting_from(); empty: a sweep. Used with `only` and `rows`.
  std::string setting;
  /// JSON file for the measurements of `setting`.
  std::string rows;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, TradeOptions& options);

/// Checks combinations of options. Call after parsing. Throws CLI::ParseError for wrong usage.
void complete_options(const CLI::App& command, TradeOptions& options);

struct FarmOptions {
  /// File that lists the jobs; see read_manifest().
  std::string manifest;
  /// Folder of the results.
  std::string out;
  /// Number of concurrent jobs; 0: one per processor.
  int processes = 0;
  /// Names of the jobs to run, with the jobs that they need; empty: all.
  std::vector<std::string> jobs;
  /// Script to print instead of running the jobs; unset: the jobs are run.
  std::optional<BatchForm> emit;
  /// JSON file to write; empty: not written.
  std::string report;
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, FarmOptions& options);

}  // namespace roomradar
