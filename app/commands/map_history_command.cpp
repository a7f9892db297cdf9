// map_history_command.cpp: roomradar map log|restore|undo|prune: earlier revisions of a map.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands/commands.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/map/map_history.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

/// Returns "2 appeared, 1 vanished"; empty without changes.
std::string describe(const std::vector<VisitChange>& changes) {
  std::map<std::string, int> counts;
  for (const VisitChange& change : changes) ++counts[change.kind];
  std::string text;
  for (const auto& [kind, count] : counts)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  return text;
}

nlohmann::json json_of(const Visit& visit) {
  const auto numbers = [](const Eigen::Vector3d& p) { return nlohmann::json{p.x(), p.y(), p.z()}; };
  nlohmann::json json = {{"revision", visit.revision},
                         {"made_at", visit.made_at},
                         {"made_by", visit.note.made_by},
                         {"source", visit.note.source},
                         {"changes", nlohmann::json::array()}};
  for (const VisitChange& change : visit.note.changes)
    json["changes"].push_back({{"kind", change.kind},
                               {"min_m", numbers(change.box_world.min())},
                               {"max_m", numbers(change.box_world.max())}});
  return json;
}

void print_line(const std::string& map, const Visit& visit) {
  const std::string changes = describe(visit.note.changes);
  std::printf("%s@%d  %-20s  %s%s%s%s%s\n", map.c_str(), visit.revision, visit.made_at.c_str(),
              visit.note.made_by.c_str(), visit.note.source.empty() ? "" : " of ", visit.note.source.c_str(),
              changes.empty() ? "" : ": ", changes.c_str());
}

}  // namespace

int run(const MapLogOptions& options) {
  const std::vector<Visit> visits = map_visits(options.map);
  if (options.json) {
    nlohmann::json json = nlohmann::json::array();
    for (const Visit& visit : visits) json.push_back(json_of(visit));
    std::printf("%s\n", json.dump(2).c_str());
    return 0;
  }
  for (const Visit& visit : visits) print_line(options.map, visit);
  return 0;
}

int run(const MapRestoreOptions& options) {
  const RevisionName name = parse_revision_name(options.revision);
  print_line(name.folder.string(), restore_revision(name.folder, name.revision));
  return 0;
}

int run(const MapUndoOptions& options) {
  print_line(options.map, undo_last_visit(options.map));
  return 0;
}

int run(const MapPruneOptions& options) {
  const int removed = prune_map(options.map, options.keep);
  std::printf("%s: %d revision%s removed, %zu left\n", options.map.c_str(), removed, removed == 1 ? "" : "s",
              map_visits(options.map).size());
  return 0;
}

}  // namespace roomradar
