// map_options.hpp: options of `roomradar map info|verify|export|merge|diff`.
#pragma once
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace roomradar {

struct MapInfoOptions {
  /// Map folder to read.
  std::string map;
  /// True: prints JSON.
  bool json = false;
};

struct MapVerifyOptions {
  /// Map folder to check.
  std::string map;
};

struct MapExportOptions {
  /// Map folder to read.
  std::string map;
  /// File to write; its extension selects the format.
  std::string path;
  /// True: exports the frontier of unknown space instead of the mesh.
  bool unknown = false;
};

struct MapMergeOptions {
  /// Folder of the map whose world frame the merged map has.
  std::string a;
  /// Folder of the map to add.
  std::string b;
  /// Map folder to write.
  std::string map;
  /// Max deviation of the merged surface's simplification; unset: that of map `a`.
  std::optional<double> deviation_m;
  /// JSON file to write; empty: not written.
  std::string report;
};

struct MapDiffOptions {
  /// Folder of the earlier map.
  std::string a;
  /// Folder of the later map.
  std::string b;
  /// JSON file to write; empty: not written.
  std::string report;
  /// PNG file to write; empty: not written.
  std::string picture;
  /// HTML file to write; empty: not written.
  std::string html;
};

/// Adds the options of `map info` with their help texts and checks. For this function and those below,
/// `options` must outlive the parsing.
void add_options(CLI::App& command, MapInfoOptions& options);
/// Adds the options of `map verify`.
void add_options(CLI::App& command, MapVerifyOptions& options);
/// Adds the options of `map export`.
void add_options(CLI::App& command, MapExportOptions& options);
/// Adds the options of `map merge`.
void add_options(CLI::App& command, MapMergeOptions& options);
/// Adds the options of `map diff`.
void add_options(CLI::App& command, MapDiffOptions& options);

}  // namespace roomradar
