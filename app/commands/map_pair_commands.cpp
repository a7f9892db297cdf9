// map_pair_commands.cpp: roomradar map merge|diff: merges or compares two maps of one room.
#include "app/commands/commands.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/registered_maps.hpp"
#include "app/cli/report.hpp"
#include "app/media/map_picture.hpp"
#include "app/media/picture_file.hpp"
#include "app/objects/kept_objects.hpp"
#include "app/page/room_page.hpp"
#include "mapping/map/map_files.hpp"
#include "mapping/map/map_history.hpp"
#include "mapping/map/map_merge.hpp"
#include "mapping/map/map_writer.hpp"
#include "mapping/map/moved_things.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/format_number.hpp"

namespace roomradar {
namespace {

bool is_part_of(const std::vector<MovedThing>& moved, std::size_t change) {
  return std::any_of(moved.begin(), moved.end(), [&](const MovedThing& thing) {
    return thing.vanished == change || thing.appeared == change;
  });
}

/// Prints a line per thing: those that moved, at their new place, then the others.
void print_changes(const std::vector<Change>& changes, const std::vector<MovedThing>& moved) {
  if (changes.empty()) {
    std::printf("nothing appeared, nothing vanished\n");
    return;
  }
  const auto print = [](const char* kind, const Change& change) {
    const Eigen::Vector3d &at = change.position_world, size = change.box_world.sizes();
    std::printf("%-8s  %7.2f %7.2f %7.2f  %6.2f %6.2f %6.2f  %7.1f", kind, at.x(), at.y(), at.z(), size.x(),
                size.y(), size.z(), 1e3 * change.volume_m3);
  };
  std::printf("%-8s  %7s %7s %7s  %6s %6s %6s  %7s\n", "", "x m", "y m", "z m", "size x", "y", "z m",
              "litres");
  for (const MovedThing& thing : moved) {
    print("moved", changes[thing.appeared]);
    const Eigen::Vector3d& from = changes[thing.vanished].position_world;
    std::printf("  by %.2f m from %.2f %.2f %.2f, turned by %.0f degrees\n", thing.moved_m, from.x(),
                from.y(), from.z(), thing.turned_deg);
  }
  for (std::size_t i = 0; i < changes.size(); ++i) {
    if (is_part_of(moved, i)) continue;
    print(to_string(changes[i].kind).data(), changes[i]);
    std::printf("\n");
  }
}

nlohmann::json json_of(const std::vector<Change>& changes, const std::vector<MovedThing>& moved) {
  nlohmann::json rows = nlohmann::json::array();
  const auto add = [&](const char* kind, const Change& change) {
    rows.push_back({{"kind", kind},
                    {"position_m", to_json(change.position_world)},
                    {"size_m", to_json(Eigen::Vector3d(change.box_world.sizes()))},
                    {"area_m2", change.area_m2},
                    {"volume_m3", change.volume_m3}});
  };
  for (const MovedThing& thing : moved) {
    add("moved", changes[thing.appeared]);
    rows.back()["from_m"] = to_json(changes[thing.vanished].position_world);
    rows.back()["moved_m"] = thing.moved_m;
    rows.back()["turned_deg"] = thing.turned_deg;
    rows.back()["same_shape"] = thing.same_shape;
  }
  for (std::size_t i = 0; i < changes.size(); ++i)
    if (!is_part_of(moved, i)) add(to_string(changes[i].kind).data(), changes[i]);
  return rows;
}

}  // namespace

int run(const MapMergeOptions& options) {
  Report report;
  report.command = "map merge";
  report.source = options.a + ", " + options.b;
  report.settings = {{"a", options.a}, {"b", options.b}, {"map", options.map}};
  require_can_become_map(options.map, {options.report});
  require_writable(options.report);
  const OpenedMap opened_a(options.a), opened_b(options.b);
  SavedMap a = load_map(opened_a.folder());
  const SavedMap b = load_map(opened_b.folder());
  if (options.deviation_m) {
    a.info.settings[kDeviationSetting] = format_number(*options.deviation_m);
    report.settings["deviation_m"] = *options.deviation_m;
  }
  if (octree_checksum(a.info) == octree_checksum(b.info))
    throw Error(options.b + ": is the same map as " + options.a +
                "; merged with itself, it would count every observation twice");
  const Registration found = require_registered(a, b, options.a, options.b, report);
  SavedMap both = report.times.timed("merge", [&] { return merge_maps(std::move(a), b, found.T_a_b); });
  both.made = {"map merge", without_folders(options.a) + " and " + without_folders(options.b), {}};
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
  const OpenedMap opened_a(options.a), opened_b(options.b);
  const SavedMap a = load_map(opened_a.folder()), b = load_map(opened_b.folder());
  const MapChanges found = changes_between(a, b, options.a, options.b, report);
  const std::vector<Change>& changes = found.changes;

  const std::vector<MovedThing> moved =
      find_moved_things(changes, surface_of_both(a.octree.load(), b.octree.load(), found.T_a_b.inverse()));
  print_changes(changes, moved);
  report.results["changes"] = json_of(changes, moved);
  if (!options.picture.empty()) write_png(draw_changes(a.mesh, changes), options.picture);
  if (!options.html.empty())
    report.times.timed("page", [&] {
      write_diff_page({a, options.a}, {b, options.b}, found.T_a_b, changes, options.html);
    });
  write_report(report, options.report);
  return 0;
}

}  // namespace roomradar
