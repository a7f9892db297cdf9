// tile_window.hpp: loads the tiles of a building around the camera, and adds them to the scene between
// frames.
#pragma once
#include <Eigen/Geometry>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "app/objects/shape.hpp"
#include "app/session/tiles/tile_choice.hpp"
#include "mapping/building/building_info.hpp"
#include "mapping/surface/unknown/unknown_surface.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"
#include "mapping/types/system/stage_times.hpp"
#include "radar/depth/raster_mesh.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"

namespace roomradar {

struct LoadedTile {
  Mesh mesh;               ///< surface in the world, without normals and colours
  TriangleTree tree;       ///< of `mesh`
  RasterMesh pieces;       ///< of `tree`
  UnknownSurface unknown;  ///< frontier of unknown space within the tile; its mesh_world is empty
  TriangleTree unknown_tree;
};

/// Reads a tile, without its octree. The frontier of unknown space is open on faces of the cube that adjoin
/// another tile, since that tile contains the frontier there.
///
/// Thread safe. Throws Error naming the file and the fault if a file is missing or damaged.
/// @param tile         index in building.tiles
/// @param has_unknown  false: the frontier of unknown space is left empty, and its file is not read
LoadedTile load_tile(const BuildingInfo& building, const std::filesystem::path& folder, std::size_t tile,
                     bool has_unknown);

/// A loaded tile that frames use.
struct SessionTile {
  std::size_t index;  ///< index in BuildingInfo::tiles
  Shape shape;
  std::optional<RasterMesh> pieces;  ///< of `shape`, until a renderer takes them
  UnknownSurface unknown;            ///< without mesh
  TriangleTree unknown_tree;

  SessionTile(GlContext& context, std::size_t its_index) : index(its_index), shape(context) {}
};

struct TileCounts {
  std::int64_t loaded = 0, dropped = 0;
  std::int64_t frames_over_33_ms = 0;  ///< frames delayed by more than 33 ms by adding a tile
  /// Stages: `frame`, the time per frame for adding and dropping tiles; `blocked`, the time per frame of
  /// waiting for the worker thread; `late`, the time per loaded tile during which the tile was in view but
  /// not in use.
  StageTimes times;
};

/// Loads tiles on a worker thread, one after the other, nearest first. Adds at most one tile per frame. A
/// tile with a missing or damaged file is never tried again, and reported as a fault. Not thread safe: call
/// all functions on the constructing thread, whose GL context is used.
class TileWindow {
 public:
  /// Throws Error if a config is invalid. `context` must outlive the window.
  TileWindow(GlContext& context, TileWindowConfig config);
  ~TileWindow();
  TileWindow(const TileWindow&) = delete;
  TileWindow& operator=(const TileWindow&) = delete;

  /// Call before each frame. Drops up to two tiles that are no longer chosen, and adds a tile that is due.
  /// Returns true if the surfaces have changed.
  bool begin_frame(double stamp_s);
  /// Chooses the tiles that contain the frame's surfaces, and those near the camera's present or predicted
  /// position, and begins to load them. Call with the camera's pose, or with a possible pose of an untracked
  /// camera.
  void follow(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Returns true if the tiles that contain the surfaces of a frame at this pose are loaded, as far as memory
  /// allows. Returns false if none of them can be loaded.
  [[nodiscard]] bool is_ready_for(const Frame& frame, const Eigen::Isometry3d& T_world_camera) const;
  /// Returns true if all tiles of the building whose cubes intersect the box are loaded.
  [[nodiscard]] bool is_loaded(const Eigen::AlignedBox3d& box_world) const;
  /// Returns true if the point is in unknown space (see is_unknown()), or not in a loaded tile.
  [[nodiscard]] bool is_unknown_at(const Eigen::Vector3d& p_world) const;

  [[nodiscard]] const std::vector<std::unique_ptr<SessionTile>>& tiles() const { return tiles_; }
  [[nodiscard]] const TileWindowConfig& config() const { return config_; }
  /// One per tile of the building: true if it is loaded.
  [[nodiscard]] const std::vector<bool>& loaded() const { return is_loaded_; }
  [[nodiscard]] const TileCounts& counts() const { return counts_; }
  /// Returns true if there is a fault that take_fault() has not returned: a tile that could not be read, or,
  /// once, a tile in view for which memory does not suffice.
  [[nodiscard]] bool has_fault() const { return !fault_.empty(); }
  std::string take_fault() { return std::exchange(fault_, {}); }

 private:
  using Clock = std::chrono::steady_clock;

  struct Loading {
    std::size_t tile;
    double due_s;
    std::future<LoadedTile> done;
  };

  GlContext& context_;
  TileWindowConfig config_;
  std::vector<std::unique_ptr<SessionTile>> tiles_;
  std::vector<bool> is_loaded_, has_failed_;  ///< by tile of the building
  std::vector<std::optional<Clock::time_point>>
      missed_since_;                 ///< by tile, while it is in view but not in use
  std::vector<std::size_t> chosen_;  ///< nearest first
  std::optional<Loading> loading_;
  std::optional<Eigen::Vector3d> position_world_;
  double position_stamp_s_ = 0.0, stamp_s_ = 0.0;
  Eigen::Vector3d velocity_world_mps_ = Eigen::Vector3d::Zero();
  bool has_told_memory_ = false;
  std::string fault_;  ///< fault of the last tile; a frame adds at most one tile
  TileCounts counts_;

  bool drop_unchosen();
  bool take_up_due();
  void take_up(std::size_t tile, LoadedTile loaded);
  void load_next();
  void limit_memory();
  void tell_too_little_memory(std::size_t tile);
  void set_velocity(const Eigen::Vector3d& position_world);
  [[nodiscard]] std::vector<std::size_t> in_view_of(const Frame& frame,
                                                    const Eigen::Isometry3d& T_world_camera) const;
  [[nodiscard]] std::vector<std::size_t> chosen_at(const Eigen::Vector3d& position_world,
                                                   std::span<const std::size_t> in_view) const;
};

}  // namespace roomradar
