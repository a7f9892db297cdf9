// room_page.hpp: one HTML file that shows a scanned room, or the changes between two scans, in a browser.
#pragma once
#include <Eigen/Geometry>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mapping/coverage/holes.hpp"
#include "mapping/map/map_diff.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/texture/surface_texture.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/trajectory.hpp"

namespace roomradar {

/// A room's surface on a page. The pointers must remain valid while the page is written. Only `texture` may
/// be null.
struct PageRoom {
  std::string name;  ///< shown if the page has several rooms
  const Mesh* mesh_world = nullptr;
  const SurfaceTexture* texture = nullptr;  ///< must fit the mesh; null: the vertices' colours are shown
};

struct RoomPage {
  std::string title;
  std::vector<PageRoom> rooms;  ///< one or two, in a common world frame
  std::vector<Hole> holes{};
  std::vector<TimedPose> trajectory{};
  std::vector<Change> changes{};  ///< kVanished belongs to rooms[0], kAppeared to rooms[1]
};

/// Writes room, texture and program as one file that needs WebGL 2, but no network. Positions are rounded to
/// 1/65535 of the room's extent along each axis. In the page, users can turn the room, walk in it, cut it and
/// measure distances. The page lists changes, and holes inside the scan. The page draws at most about 4,000
/// poses of the trajectory. An existing file is replaced only by the complete new file.
/// @throws Error if a room has no triangles, or the file cannot be written
void write_room_page(const RoomPage& page, const std::filesystem::path& path);

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
