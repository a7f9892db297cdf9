// changed_map.hpp: saves a map whose octree was changed since it was loaded.
#pragma once
#include <cstddef>
#include <filesystem>

#include "mapping/map/map_folder.hpp"

namespace roomradar {

/// Saves a map with changes of its octree: extracts the whole surface again, carries the texture over, and
/// surveys the coverage. Records the number of changes in the map's settings. Without changes, saves the map
/// as it is. Throws Error as save_map() does.
void save_changed_map(SavedMap& map, std::size_t changes, const std::filesystem::path& folder);

}  // namespace roomradar
