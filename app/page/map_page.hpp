// map_page.hpp: writes HTML pages of saved maps.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <span>
#include <string>

#include "mapping/map/map_diff.hpp"
#include "mapping/map/map_folder.hpp"

namespace roomradar {

/// Returns true if the path ends in .html.
bool is_page(const std::filesystem::path& path);

/// Writes a page of a map, with the surface, the texture if the map has one, the scan's camera trajectory and
/// the holes. Throws Error as write_room_page() does, or if a file of the map is damaged.
/// @param folder  the map's folder; its name becomes the title
void write_map_page(const SavedMap& map, const std::filesystem::path& folder,
                    const std::filesystem::path& path);

/// A loaded map and its folder.
struct NamedMap {
  const SavedMap& map;
  std::string folder;
};

/// Writes a page of two maps of one room, with the objects that appeared and vanished between them. Throws
/// Error as write_map_page() does.
/// @param T_a_b    transforms points from b's world frame to a's world frame
/// @param changes  in the world frame of map a
void write_diff_page(const NamedMap& a, const NamedMap& b, const Eigen::Isometry3d& T_a_b,
                     std::span<const Change> changes, const std::filesystem::path& path);

}  // namespace roomradar
