// map_options.hpp: options of `roomradar map`, `building` and `serve`.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "mapping/building/tile_grid.hpp"
#include "mapping/types/pose_origin.hpp"

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

struct MapObjectsOptions {
  /// Map folder whose objects are listed or changed.
  std::string map;
  /// "list", "remove" or "rename".
  std::string action = "list";
  /// Names for the action: none, the object, or its old and new name.
  std::vector<std::string> names;
};

struct MapLogOptions {
  /// Map folder whose revisions are listed.
  std::string map;
  /// True: prints JSON.
  bool json = false;
};

struct MapListOptions {
  /// Folder that holds maps.
  std::string folder = "maps";
  /// True: prints JSON.
  bool json = false;
};

struct MapRestoreOptions {
  /// Revision to restore, as `FOLDER@N`.
  std::string revision;
};

struct MapUndoOptions {
  /// Map folder.
  std::string map;
};

struct MapPruneOptions {
  /// Map folder.
  std::string map;
  /// Number of revisions that stay.
  int keep = 1;
};

struct MapCopyOptions {
  /// Map folder to copy.
  std::string map;
  /// Map folder to make.
  std::string to;
};

struct MapRenameOptions {
  /// Map folder to move.
  std::string map;
  /// Its new path.
  std::string to;
};

struct MapDeleteOptions {
  /// Map folder to delete.
  std::string map;
  /// True: deletes the map instead of moving it to the trash.
  bool for_good = false;
};

struct MapPackOptions {
  /// Map folder to pack.
  std::string map;
  /// File to write, with the extension .rrm.
  std::string file;
};

struct MapUnpackOptions {
  /// File that `map pack` wrote.
  std::string file;
  /// Map folder to make; empty: in the current folder, with the map's name when it was packed.
  std::string map;
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

struct BuildingOptions {
  /// Folder of the building; created or updated.
  std::string folder;
  /// File with the list of recordings; see read_recording_list().
  std::string recordings;
  TileGrid grid;
  /// Max deviation of the surface's simplification.
  double deviation_m = 0.002;
  /// Origin of the camera poses.
  PoseOrigin poses = PoseOrigin::kAuto;
  /// Max number of concurrent jobs; 0: one per processor.
  int processes = 0;
  /// JSON file to write; empty: not written.
  std::string report;
};

struct ServeOptions {
  /// Map folders to serve.
  std::vector<std::string> maps;
  /// Address and port; see parse_listen_address().
  std::string listen = "127.0.0.1:8080";
  /// True: accepts an address that other machines reach.
  bool allow_remote = false;
  /// File with the token that each request must have; empty: no token.
  std::string token_file;
  /// Place of the map's origin on the earth; see parse_geo_anchor(). Empty: none.
  std::string anchor;
  /// True: prints a line per request.
  bool verbose = false;
};

/// Adds the options of `map info` with their help texts and checks. For this function and those below,
/// `options` must outlive the parsing.
void add_options(CLI::App& command, MapInfoOptions& options);
/// Adds the options of `map verify`.
void add_options(CLI::App& command, MapVerifyOptions& options);
/// Adds the options of `map export`.
void add_options(CLI::App& command, MapExportOptions& options);
/// Adds the options of `map objects`.
void add_options(CLI::App& command, MapObjectsOptions& options);
/// Checks the number of names. Call after parsing. Throws CLI::ValidationError for wrong usage.
void complete_options(const CLI::App& command, const MapObjectsOptions& options);
/// Adds the options of `map log`.
void add_options(CLI::App& command, MapLogOptions& options);
/// Adds the options of `map restore`.
void add_options(CLI::App& command, MapRestoreOptions& options);
/// Adds the options of `map undo`.
void add_options(CLI::App& command, MapUndoOptions& options);
/// Adds the options of `map prune`.
void add_options(CLI::App& command, MapPruneOptions& options);
/// Adds the options of `map list`.
void add_options(CLI::App& command, MapListOptions& options);
/// Adds the options of `map copy`.
void add_options(CLI::App& command, MapCopyOptions& options);
/// Adds the options of `map rename`.
void add_options(CLI::App& command, MapRenameOptions& options);
/// Adds the options of `map delete`.
void add_options(CLI::App& command, MapDeleteOptions& options);
/// Adds the options of `map pack`.
void add_options(CLI::App& command, MapPackOptions& options);
/// Adds the options of `map unpack`.
void add_options(CLI::App& command, MapUnpackOptions& options);
/// Adds the options of `map merge`.
void add_options(CLI::App& command, MapMergeOptions& options);
/// Adds the options of `map diff`.
void add_options(CLI::App& command, MapDiffOptions& options);
/// Adds the options of `building`.
void add_options(CLI::App& command, BuildingOptions& options);
/// Adds the options of `serve`.
void add_options(CLI::App& command, ServeOptions& options);

}  // namespace roomradar
