// trade_options.hpp: options of `roomradar trade`.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace roomradar {

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

}  // namespace roomradar
