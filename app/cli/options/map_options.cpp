// map_options.cpp: option names, help texts and checks of the `roomradar map` commands.
#include "app/cli/options/map_options.hpp"

#include <CLI/CLI.hpp>

#include "app/cli/options/option_checks.hpp"
#include "app/cli/options/shared_options.hpp"

namespace roomradar {
namespace {

void add_map_argument(CLI::App& command, std::string& map) {
  command.add_option("DIR", map, "folder of the map of a room or a building (required)")->required();
}

void add_room_argument(CLI::App& command, std::string& map) {
  command.add_option("DIR", map, "folder of the map of a room (required)")->required();
}

}  // namespace

void add_options(CLI::App& command, MapInfoOptions& options) {
  add_map_argument(command, options.map);
  command.add_flag("--json", options.json, "print all of it as JSON, for other programs (default: off)");
}

void add_options(CLI::App& command, MapVerifyOptions& options) { add_map_argument(command, options.map); }

void add_options(CLI::App& command, MapExportOptions& options) {
  add_map_argument(command, options.map);
  command
      .add_option(
          "FILE", options.path,
          "file to write, by extension: .html (page for a browser: the room to turn, walk in and measure),\n"
          ".glb .obj (mesh with texture), .ply .stl (mesh), .ot .bt (octree), .png (of a building: a plan "
          "of\n"
          "each floor) (required)")
      ->required();
  command.add_flag("--unknown", options.unknown,
                   "write the frontier of unknown space instead of the room's mesh (default: off)");
}

void add_options(CLI::App& command, MapObjectsOptions& options) {
  add_room_argument(command, options.map);
  command.add_option("ACTION", options.action, "list, remove NAME, or rename OLD NEW (default: list)")
      ->check(CLI::IsMember({"list", "remove", "rename"}));
  command.add_option("NAME", options.names, "names of objects, for the action (default: none)");
}

void complete_options(const CLI::App& /*command*/, const MapObjectsOptions& options) {
  const std::size_t wanted = options.action == "list" ? 0 : options.action == "remove" ? 1 : 2;
  if (options.names.size() != wanted)
    throw CLI::ValidationError("map objects DIR " + options.action + ": takes " + std::to_string(wanted) +
                               " names, " + std::to_string(options.names.size()) + " are given");
}

void add_options(CLI::App& command, MapLogOptions& options) {
  add_room_argument(command, options.map);
  command.add_flag("--json", options.json, "print all of it as JSON, for other programs (default: off)");
}

void add_options(CLI::App& command, MapRestoreOptions& options) {
  command
      .add_option("DIR@N", options.revision,
                  "folder of a room's map, and the number of a revision (required)")
      ->required();
}

void add_options(CLI::App& command, MapUndoOptions& options) { add_room_argument(command, options.map); }

void add_options(CLI::App& command, MapPruneOptions& options) {
  add_room_argument(command, options.map);
  command.add_option("--keep", options.keep, "number of revisions that stay, the latest ones (required)")
      ->required()
      ->check(whole_within(1, 1'000'000))
      ->type_name("N");
}

void add_options(CLI::App& command, MapListOptions& options) {
  command.add_option("FOLDER", options.folder, "folder that holds maps (default: maps)");
  command.add_flag("--json", options.json, "print the list as JSON, for other programs (default: off)");
}

void add_options(CLI::App& command, MapCopyOptions& options) {
  add_room_argument(command, options.map);
  command.add_option("TO", options.to, "folder for the copy; must not exist (required)")->required();
}

void add_options(CLI::App& command, MapRenameOptions& options) {
  add_room_argument(command, options.map);
  command.add_option("TO", options.to, "new path of the folder; must not exist (required)")->required();
}

void add_options(CLI::App& command, MapDeleteOptions& options) {
  add_room_argument(command, options.map);
  command.add_flag("--for-good", options.for_good,
                   "delete the map instead of moving it to the trash, ~/.local/share/Trash (default: off)");
}

void add_options(CLI::App& command, MapPackOptions& options) {
  add_room_argument(command, options.map);
  command.add_option("FILE", options.file, "file to write; its name must end in .rrm (required)")->required();
}

void add_options(CLI::App& command, MapUnpackOptions& options) {
  command.add_option("FILE", options.file, "file that `map pack` wrote (required)")->required();
  command
      .add_option("--map", options.map,
                  "folder for the map; must not exist (default: in this folder, with the name it had when\n"
                  "it was packed)")
      ->type_name("DIR");
}

void add_options(CLI::App& command, MapMergeOptions& options) {
  command.add_option("A", options.a, "map whose world frame is kept (required)")->required();
  command.add_option("B", options.b, "map to add; the finer resolution of both is used (required)")
      ->required();
  command.add_option("--map", options.map, "folder for the merged map (required)")
      ->required()
      ->type_name("DIR");
  command
      .add_option("--deviation", options.deviation_m,
                  "max distance of the simplified mesh from the full mesh, metres; 0 keeps all triangles\n"
                  "(default: as for A)")
      ->check(within(0.0, 1.0, "metres"))
      ->type_name("M");
  add_report_option(command, options.report);
}

void add_options(CLI::App& command, MapDiffOptions& options) {
  command.add_option("A", options.a, "earlier map (required)")->required();
  command.add_option("B", options.b, "later map (required)")->required();
  add_report_option(command, options.report);
  command
      .add_option("--picture", options.picture,
                  "draw A, with appeared parts in green and vanished parts in red (default: not written)")
      ->type_name("FILE.png");
  command
      .add_option(
          "--html", options.html,
          "page for a browser: both rooms in 3D, with what appeared and vanished (default: not written)")
      ->type_name("FILE.html");
}

void add_options(CLI::App& command, BuildingOptions& options) {
  command
      .add_option("DIR", options.folder, "folder of the building; is made, or brought up to date (required)")
      ->required();
  command
      .add_option("--recordings", options.recordings,
                  "list of the recordings, one per line: NAME: SOURCE (required)")
      ->required()
      ->type_name("LIST");
  command
      .add_option("--resolution", options.grid.resolution_m,
                  with_default("edge of the smallest voxels, m", options.grid.resolution_m))
      ->check(within(0.001, 1.0, "metres"))
      ->type_name("M");
  command
      .add_option(
          "--tile-edge", options.grid.edge_voxels,
          with_default("edge of a tile in voxels, a power of two from 64 to 4096", options.grid.edge_voxels))
      ->type_name("N");
  command
      .add_option("--deviation", options.deviation_m,
                  with_default("how far simplification may move the surface, m", options.deviation_m))
      ->check(within(0.0, 0.1, "metres"))
      ->type_name("M");
  add_poses_option(
      command, options.poses,
      "estimate the camera poses, with those of the recordings as a prior (auto) or without them\n"
      "(tracked), or use those of the recordings, which must be in one world (recorded)");
  add_processes_option(command, options.processes);
  add_report_option(command, options.report);
}

void add_options(CLI::App& command, ServeOptions& options) {
  command.add_option("MAP", options.maps, "folders of buildings and of rooms' maps (required)")->required();
  command
      .add_option("--listen", options.listen,
                  "address and port; port 0 takes a free one and prints it (default: 127.0.0.1:8080)")
      ->type_name("ADDRESS:PORT");
  command.add_flag("--allow-remote", options.allow_remote,
                   "allow an address that other machines reach; needs --token-file. The connection is not\n"
                   "encrypted: put a proxy with TLS in front of it (default: off)");
  command
      .add_option("--token-file", options.token_file,
                  "file with the token that each request must have (default: no token)")
      ->type_name("FILE");
  command
      .add_option(
          "--anchor", options.anchor,
          "place of the map's origin on the earth, for answers as GeoPose: degrees, degrees, m above the\n"
          "ellipsoid, and the direction of +y in degrees clockwise from north (default: none)")
      ->type_name("LAT,LON,HEIGHT,HEADING");
  command.add_flag("--verbose", options.verbose, "print a line per request to stderr (default: off)");
}

}  // namespace roomradar
