// map_options.hpp: options of `roomradar map info|verify|export|merge|diff`.
#pragma once
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

struct MapInfoOptions {
  std::string map;  ///< folder
};

struct MapVerifyOptions {
  std::string map;  ///< folder
};

struct MapExportOptions {
  std::string map;       ///< folder
  std::string path;      ///< file to write; its extension selects the format
  bool unknown = false;  ///< export the border of unknown space instead of the mesh
};

struct MapMergeOptions {
  std::string a;                      ///< folder of the map whose world frame is kept
  std::string b;                      ///< folder of the map to add
  std::string map;                    ///< folder to write
  std::optional<double> deviation_m;  ///< max deviation of the merged surface; unset: as in map a
  std::string report;                 ///< JSON file to write; empty: not written
};

struct MapDiffOptions {
  std::string a;        ///< folder of the earlier map
  std::string b;        ///< folder of the later map
  std::string report;   ///< JSON file to write; empty: not written
  std::string picture;  ///< PNG file to write; empty: not written
};

/// Each adds the options of one command with their help texts and checks.
/// @param options  receives the values; must outlive the parsing
void add_options(CLI::App& command, MapInfoOptions& options);
void add_options(CLI::App& command, MapVerifyOptions& options);
void add_options(CLI::App& command, MapExportOptions& options);
void add_options(CLI::App& command, MapMergeOptions& options);
void add_options(CLI::App& command, MapDiffOptions& options);

}  // namespace roomradar
