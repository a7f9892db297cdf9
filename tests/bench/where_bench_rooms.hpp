// where_bench_rooms.hpp: maps to localise in, and views of them from poses that the scan did not visit.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "app/session/frame_scene.hpp"
#include "app/sim/sensor/simulated_source.hpp"
#include "mapping/localization/locator.hpp"
#include "mapping/map/map_folder.hpp"
#include "mapping/prescan.hpp"

namespace roomradar {

/// A room with its map, as the command `run` loads it.
struct SearchedRoom {
  explicit SearchedRoom(SavedMap saved) : map(std::move(saved)), room(context), scene(context, room, {}) {
    room.set(map.mesh, MeshUsage::kStatic);
  }
  /// Localises the frame from the locator's state; pixels of `dynamic_mask` (foreground of the previous
  /// frame) are ignored.
  Tracking find(Locator& locator, const Frame& frame, const MaskImage& dynamic_mask = {});

  SavedMap map;
  GlContext context;
  Shape room;
  FrameScene scene;
  double drawing_ms = 0.0;  ///< time of this thread spent on rendering expected depth so far
};

/// Returns the map of a source: loaded from `folder` if present there, else scanned and saved to it.
SavedMap map_of(FrameSource& source, PoseOrigin poses, const std::filesystem::path& folder);

/// Options of a room's scan: a walk once around it.
SimOptions scan_of(const std::string& room, std::uint64_t seed);

struct FreeViews {
  double clear_m = 0.35;    ///< min distance from all solids
  double off_path_m = 0.5;  ///< min distance from every camera of the scan
  double min_mapped = 0.6;  ///< min fraction of the image that shows mapped surface within max_depth_m
  double max_depth_m = 5.0;
  /// Fraction of the image that shows more than bare floor, walls and ceiling: a min, or a max if `bare` is
  /// set.
  double things = 0.1;
  bool bare = false;
};

/// Returns random poses in the free space of a room, at, above and below eye height, in any heading but
/// roughly upright, that look at mapped surface. Room frame. Deterministic.
std::vector<Eigen::Isometry3d> draw_free_views(const Room& room, const SavedMap& map,
                                               const std::vector<Eigen::Isometry3d>& T_room_scan,
                                               std::size_t count, std::uint64_t seed,
                                               const FreeViews& which = {});

/// Returns the camera poses of a scan, in the room's frame.
std::vector<Eigen::Isometry3d> poses_of(const SimOptions& scan);

}  // namespace roomradar
