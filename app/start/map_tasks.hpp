// map_tasks.hpp: tasks of the start view with saved maps: name, rename, delete, export, compare.
#pragma once
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

namespace roomradar {

/// Returns a name for a new map that is not taken, such as maps/room-2026-11-26 or maps/room-2026-11-26-2.
/// @param folder  folder that contains `maps`
std::string proposed_map_name(const std::filesystem::path& folder, std::time_t now);

/// Renames the map, within its parent folder. Returns the new path. Throws Error, with the map unchanged, if
/// the name is empty, has a slash or is taken, the map has an interrupted scan, or the system refuses.
std::filesystem::path rename_map(const std::filesystem::path& map, const std::string& new_name);

/// Deletes the map, and its interrupted scan if there is one. Throws Error, with nothing deleted, if the
/// folder is not a map, is a link, or contains anything that is not part of a map.
void delete_map(const std::filesystem::path& map);

/// Exports the map to a file in the map's parent folder, such as NAME.glb, or NAME-2.glb if NAME.glb exists.
/// Returns the path. Throws Error as export_map() and write_map_page() do.
/// @param extension  .html (a page), .glb or .ply
std::filesystem::path export_beside(const std::filesystem::path& map, const std::string& extension);

/// Returns sentences on what appeared in map b and what vanished since map a. Takes several seconds. Throws
/// Error if a map cannot be read, or the maps cannot be registered as maps of the same room.
std::vector<std::string> compare_maps(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace roomradar
