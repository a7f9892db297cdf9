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
  std::vector<std::string> recordings;  ///< folders with poses, in addition to the rooms
  std::vector<std::string> rooms = {"table", "random?seed=2"};  ///< in the form of `sim:`
  std::string only;                                             ///< prescan or run; empty: both
  std::size_t settings = 30;       ///< number of settings per command, in addition to the default
  int repeats = 2;                 ///< measurements per setting and scene
  std::uint64_t seed = 1;          ///< seed of the settings and of their order
  std::string time = "wall";       ///< time by which settings are compared: wall or cpu
  int objects = 1;                 ///< default number of virtual objects in a run
  bool quick = false;              ///< few frames of small images
  bool compare_published = false;  ///< only compare with the published radar's table
  std::string csv;                 ///< file with a line per measurement; empty: not written
  std::string html;                ///< file for plots and tables; empty: not written
  std::string presets;             ///< presets file to write; empty: not written
  std::string report;              ///< JSON file to write; empty: not written
};

/// Adds the options with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, TradeOptions& options);

/// Checks the options against each other; call after parsing. Throws CLI::ParseError for wrong usage.
void complete_options(const CLI::App& command, TradeOptions& options);

}  // namespace roomradar
