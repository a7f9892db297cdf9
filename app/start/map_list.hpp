// map_list.hpp: the saved maps that a user can choose from, and their properties for display.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar {

struct MapEntry {
  std::filesystem::path folder;
  std::time_t saved_at = 0;  ///< time at which map.json, or FOLDER.unfinished, was written
  std::uint64_t bytes = 0;   ///< total size of all files
  Eigen::Vector3d size_m = Eigen::Vector3d::Zero();  ///< size of the bounding box of all occupied space
  std::string source;                                ///< recordings or devices from which the map was scanned
  bool has_unfinished_scan = false;                  ///< FOLDER.unfinished exists
  bool is_saved = true;                              ///< false: only FOLDER.unfinished exists
  std::string fault;  ///< sentence on why the map cannot be used; empty if it can
};

/// Properties of a map that take time to compute.
struct MapDetails {
  ColourImage picture;             ///< rendering of the room, obliquely from above
  double surface_m2 = 0.0;         ///< whole surface
  std::optional<double> floor_m2;  ///< floor; unset: none was found
  std::size_t holes = 0;           ///< unobserved regions inside the scan
  std::size_t outer_holes = 0;     ///< unobserved regions at the scan's outer borders
  double largest_hole_m2 = 0.0;
  std::string fault;  ///< sentence on why the fields above are incomplete; empty: they are complete
};

/// Returns the path of the folder for an interrupted scan of this map. The folder need not exist.
std::filesystem::path unfinished_scan_of(const std::filesystem::path& map);

/// Returns true if `folder` is a saved map, or if an interrupted scan of it exists.
bool is_map(const std::filesystem::path& folder);

/// Reads map.json. Never throws: MapEntry::fault states an error.
MapEntry describe_map(const std::filesystem::path& folder);

/// Returns the maps among the subfolders of `folder`/maps and of `folder`, and `folder` itself if it is a
/// map; newest first. Considers subfolders().
std::vector<MapEntry> list_maps(const std::filesystem::path& folder);

/// Loads the map, renders a picture of this width, and searches for holes. Takes about a second for a room.
/// Never throws: MapDetails::fault states an error.
/// @param ground  colour around the room
MapDetails examine_map(const std::filesystem::path& folder, int width_px, Rgb ground);

/// Returns the properties as lines of text, each a name and a value: date, size, area, holes, source.
/// @param details  null: not yet computed
std::vector<std::pair<std::string, std::string>> facts_of(const MapEntry& map, const MapDetails* details);

}  // namespace roomradar
