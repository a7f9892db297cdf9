// map_places.hpp: maps as folders on the disk: which there are in a folder, what each holds, and how to copy,
// move and delete them. A process that is killed at any moment leaves the map in its old or its new place,
// whole.
#pragma once
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

namespace roomradar {

/// A map in a folder of maps.
struct MapPlace {
  std::filesystem::path folder;
  bool is_building = false;     ///< the map of a building, of which the triangles and the source are not read
  std::uintmax_t bytes = 0;     ///< total size of all files in the folder
  std::time_t saved_at = 0;     ///< time at which map.json or building.json was written; 0: not known
  std::uint64_t triangles = 0;  ///< of the mesh
  std::string source{};         ///< recordings or devices from which the map was scanned
  std::string fault{};          ///< sentence on why the map cannot be used; empty: none was found
};

/// Returns the maps directly in the folder, in the order of their names. Reads map.json, and compares the
/// files' sizes with it, but not their checksums. Throws Error if the folder cannot be listed or is a map
/// itself.
std::vector<MapPlace> map_places_in(const std::filesystem::path& folder);

/// A file in a map's folder.
struct MapContent {
  std::string name;          ///< relative to the folder, with '/' between the parts
  std::uintmax_t bytes = 0;  ///< size
  std::string version{};     ///< changes when the file is replaced or written
  friend bool operator==(const MapContent&, const MapContent&) = default;
};

/// Returns the files in the map's folder and its subfolders, sorted by name, without litter of desktops and
/// files that are being written. Throws Error if there is anything but files and folders, such as a link.
std::vector<MapContent> contents_of_map(const std::filesystem::path& folder);

/// Returns the path of a map's folder without "." and "..". Throws Error if there is no folder with the map
/// of a room, sound or damaged, or if the path is that of a link.
std::filesystem::path existing_map(const std::filesystem::path& folder);

/// Returns the path for a new map without "." and "..". Throws Error if something is there, or if it would
/// lie in another map's folder.
std::filesystem::path place_for_map(const std::filesystem::path& folder);

/// Throws Error if the folder of a map holds, beside litter of desktops, anything that is not part of a map.
void require_only_map(const std::filesystem::path& folder);

/// Throws Error if the path lies in the map's folder or in a folder below it.
void require_outside_map(const std::filesystem::path& path, const std::filesystem::path& map);

/// Copies the map with all that is in its folder. A map that is changed meanwhile is copied as it is at one
/// moment. Throws Error, with nothing left at `to`, as existing_map() and place_for_map() do, and if the disk
/// fails.
void copy_map(const std::filesystem::path& map, const std::filesystem::path& to);

/// Moves the map, also to another file system, and out of the trash. Throws Error, with the map where it was,
/// as copy_map() does.
void move_map(const std::filesystem::path& map, const std::filesystem::path& to);

/// Moves the map to the user's trash, where desktops show it (freedesktop.org, Trash 1.0), also from another
/// file system. Returns its path there. Throws Error, with the map where it was, as copy_map() and
/// require_only_map() do, or if the map lies in the trash already.
std::filesystem::path move_map_to_trash(const std::filesystem::path& map);

/// Deletes the map for good. Throws Error as existing_map() and require_only_map() do, or if the system
/// refuses.
void erase_map(const std::filesystem::path& map);

}  // namespace roomradar
