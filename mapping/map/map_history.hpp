// map_history.hpp: earlier revisions of a map: opened, restored, pruned.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "mapping/history/visits.hpp"
#include "mapping/map/map_info.hpp"
#include "mapping/storage/atomic_folder.hpp"

namespace roomradar {

/// Returns the map's files that belong to a revision: map.json, and those that it lists.
RevisionFiles revision_files(const std::filesystem::path& folder, const MapInfo& info);

/// Returns the revisions of the map, oldest first; at least one, made up if the map is of an earlier version.
std::vector<Visit> map_visits(const std::filesystem::path& folder);

/// A revision as named on a command line, `FOLDER@N`.
struct RevisionName {
  std::filesystem::path folder;
  int revision = 0;
};
/// Throws Error if the name is no `FOLDER@N`.
RevisionName parse_revision_name(const std::filesystem::path& name);

/// A map as named on a command line: a folder, or `FOLDER@N` for its revision N.
class OpenedMap {
 public:
  /// Writes revision N into a temporary folder. Takes a name that is a folder as it is. Throws Error if there
  /// is no such revision.
  explicit OpenedMap(const std::filesystem::path& name);
  ~OpenedMap();
  OpenedMap(const OpenedMap&) = delete;
  OpenedMap& operator=(const OpenedMap&) = delete;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
  [[nodiscard]] bool is_revision() const { return !temporary_.empty(); }

 private:
  std::filesystem::path folder_;
  std::filesystem::path temporary_;  ///< to be removed; empty: none
};

/// Makes an earlier revision the map's present state, with the same bytes, as a new revision. The objects
/// that are kept in the room stay. Throws Error if there is no such revision.
/// @return the new revision
Visit restore_revision(const std::filesystem::path& folder, int revision);

/// Restores the revision from which the present state was made. Undoing again goes further back.
Visit undo_last_visit(const std::filesystem::path& folder);

/// Removes all but the latest `keep` revisions. Returns how many were removed.
int prune_map(const std::filesystem::path& folder, int keep);

/// Copies the objects that are kept in the room at `from`, if there are any, into the folder of a map.
void carry_objects(const std::filesystem::path& from, const std::filesystem::path& map);

}  // namespace roomradar
