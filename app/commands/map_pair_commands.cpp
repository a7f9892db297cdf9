// map_pair_commands.cpp: roomradar map merge|diff: merges or compares two maps of one room.
#include "app/commands/commands.hpp"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/cli/registered_maps.hpp"
#include "app/cli/report.hpp"
#include "app/media/map_picture.hpp"
#include "app/media/picture_file.hpp"
#include "app/objects/kept_objects.hpp"
#include "app/page/room_page.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/map/map_merge.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
int run(const MapMergeOptions& options) {
  Report report;
  report.command = "map merge";
  report.source = options.a + ", " + options.b;
  report.settings = {{"a", options.a}, {"b", options.b}, {"map", options.map}};
  require_can_become_map(options.map, {options.report});
  require_writable(options.report);
  SavedMap a = load_map(options.a);
  const SavedMap b = load_map(options.b);
  if (options.deviation_m) {
    a.info.settings[kDeviationSetting] = format_number(*options.deviation_m);
    report.settings["deviation_m"] = *options.deviation_m;
  }
  if (octree_checksum(a.info) == octree_checksum(b.info))
    throw Error(options.b + ": is the same map as " + options.a +
                "; merged with itself, it would count every observation twice");
  const Registration found = require_registered(a, b, options.a, options.b, report);
  const SavedMap both = report.times.timed("merge", [&] { return merge_maps(std::move(a), b, found.T_a_b); });
  report.times.timed("save", [&] {
    save_map(options.map, both);
    add_kept_objects(b.objects_folder, found.T_a_b, std::filesystem::path(options.map) / kMapObjectsFolder);
  });
  report.results["map"] = {{"triangles", both.mesh.triangles.size()},
                           {"bytes", both.octree.load().memory_bytes()}};
  write_report(report, options.report);
  std::printf("%s: %zu triangles, %zu keyframes\n", options.map.c_str(), both.mesh.triangles.size(),
              both.keyframe_database.load().keyframes.size());
  return 0;
}

int run(const MapDiffOptions& options) {
  Report report;
  report.command = "map diff";
  report.source = options.a + ", " + options.b;
  report.settings = {{"a", options.a}, {"b", options.b}};
  require_writable(options.report);
  require_png_name(options.picture);
  require_writable(options.picture);
  if (!options.html.empty() && !is_page(options.html))
    throw Error(options.html + ": a page's name must end in .html");
  require_outside_maps(options.html);
  require_writable(options.html);
  const SavedMap a = load_map(options.a);
  const SavedMap b = load_map(options.b);
  const MapChanges found = changes_between(a, b, options.a, options.b, report);
  const std::vector<Change>& changes = found.changes;

  nlohmann::json rows = nlohmann::json::array();
  if (!changes.empty())
    std::printf("%-8s  %7s %7s %7s  %6s %6s %6s  %7s\n", "", "x m", "y m", "z m", "size x", "y", "z m",
                "litres");
  for (const Change& change : changes) {
    const Eigen::Vector3d &at = change.position_world, size = change.box_world.sizes();
    std::printf("%-8s  %7.2f %7.2f %7.2f  %6.2f %6.2f %6.2f  %7.1f\n", to_string(change.kind).data(), at.x(),
                at.y(), at.z(), size.x(), size.y(), size.z(), 1e3 * change.volume_m3);
    rows.push_back({{"kind", to_string(change.kind)},
                    {"position_m", to_json(at)},
                    {"size_m", to_json(size)},
                    {"area_m2", change.area_m2},
                    {"volume_m3", change.volume_m3}});
  }
  if (changes.empty()) std::printf("nothing appeared, nothing vanished\n");
  report.results["changes"] = std::move(rows);
  if (!options.picture.empty()) write_png(draw_changes(a.mesh, changes), options.picture);
  if (!options.html.empty())
    report.times.timed("page", [&] {
      write_diff_page({a, options.a}, {b, options.b}, found.T_a_b, changes, options.html);
    });
  write_report(report, options.report);
  return 0;
}

}  // namespace roomradar
