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

}  // namespace roomradar
