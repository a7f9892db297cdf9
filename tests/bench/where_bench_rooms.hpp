// where_bench_rooms.hpp: maps to be found in, and views of them from where the scan never was.
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

/// A room as `run` has it.
struct SearchedRoom {
  explicit SearchedRoom(SavedMap saved) : map(std::move(saved)), room(context), scene(context, room, {}) {
    room.set(map.mesh, MeshUsage::kStatic);
  }
  /// Looks for the frame with what the locator remembers, what moved in the frame before left out.
  Tracking find(Locator& locator, const Frame& frame, const MaskImage& dynamic_mask = {});

  SavedMap map;
  GlContext context;
  Shape room;
  FrameScene scene;
  double drawing_ms = 0.0;  ///< of the thread's time, what drawing the expected depth took so far
};

/// The map of a source, from `folder` where it lies there already, else scanned and kept there.
SavedMap map_of(FrameSource& source, PoseOrigin poses, const std::filesystem::path& folder);

/// What a room's scan was: a walk once round it.
SimOptions scan_of(const std::string& room, std::uint64_t seed);

struct FreeViews {
  double clear_m = 0.35;    ///< of all solids
  double off_path_m = 0.5;  ///< of every camera of the scan
  double min_mapped = 0.6;  ///< of the image, the part that sees what the map has, within max_depth_m
  double max_depth_m = 5.0;
  /// And the part that shows more than the bare floor, walls and ceiling, at least or, of bare views, at
  /// most.
  double things = 0.1;
  bool bare = false;
};

/// Random poses in the free space of a room, at eye height and above and below it, turned any way but
/// roughly upright, that look at what the map has. Room frame. Deterministic.
std::vector<Eigen::Isometry3d> draw_free_views(const Room& room, const SavedMap& map,
                                               const std::vector<Eigen::Isometry3d>& T_room_scan,
                                               std::size_t count, std::uint64_t seed,
                                               const FreeViews& which = {});

/// The poses of a scan, in the room's frame.
std::vector<Eigen::Isometry3d> poses_of(const SimOptions& scan);

}  // namespace roomradar
