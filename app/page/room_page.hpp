// room_page.hpp: one HTML file that shows a scanned room, or the changes between two scans, in a browser.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "mapping/coverage/hole.hpp"
#include "mapping/map/map_diff.hpp"
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

}  // namespace roomradar
