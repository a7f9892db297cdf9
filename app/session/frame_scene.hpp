// frame_scene.hpp: surfaces that virtual objects can touch in a frame: the static room and the dynamic
// foreground.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "app/objects/shape.hpp"
#include "app/session/session_config.hpp"
#include "app/session/tiles/tile_window.hpp"
#include "dynamic/foreground/foreground.hpp"
#include "dynamic/surface/depth_mesh.hpp"
#include "dynamic/surface/dynamic_surface.hpp"
#include "dynamic/surface/surface_motion.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/depth/depth_pass.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Views of the room that a FrameScene rendered for the expected depth, and room triangles drawn in them.
struct RoomDrawn {
  std::size_t views = 0, triangles = 0;
};

/// Depth of the static room in a camera's image.
struct ExpectedView {
  Intrinsics camera{};  ///< image size 0: nothing was rendered
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  DepthImage depth_m;
  std::size_t triangles = 0;  ///< number of triangles drawn
};

/// Labels of a frame's pixels, from the comparison of live and expected depth.
struct FrameForeground {
  LabelImage labels;
  MaskImage dynamic_mask;  ///< non-zero: dynamic pixel
  ForegroundCounts counts;
};

/// Rebuilds the touchable surfaces for each frame, in steps: render_expected(), find_dynamic(),
/// mesh_surfaces(). Each step takes the results of earlier steps. Returned references are valid until the
/// next call of the function that returned them. Not thread safe.
class FrameScene {
 public:
  /// @param room     static mesh of the room, in the world
  /// @param unknown  surface between observed and unobserved space, which can be touched but is not drawn.
  ///                 Null: unknown space is free.
  /// `context`, `room` and `unknown` must outlive the scene.
  /// @throws Error if `config` is invalid
  FrameScene(GlContext& context, const Shape& room, const FrameSceneConfig& config,
             const TriangleTree* unknown = nullptr);

  /// Renders the room's depth from a camera pose. Reuses the last result if the pose has changed by less than
  /// 0.2 mm and 0.2 mrad, each a tenth of a pixel at 1 m.
  const ExpectedView& render_expected(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera);
  /// Replaces all config fields except `surfaces`, from the next frame on. Does not check `config`, which
  /// must be valid.
  void set_fineness(const FrameSceneConfig& config) {
    config_.foreground = config.foreground;
    config_.moved = config.moved;
    config_.mesh = config.mesh;
  }
  /// Sets the policy that selects the touchable surfaces, from the next frame on.
  void set_surfaces(SurfacePolicy surfaces);
  /// Replaces the frontier of unknown space; null: unknown space is free.
  void set_unknown(const TriangleTree* unknown) { unknown_ = unknown; }
  /// Replaces the room by the tiles of a building. If the frontier of unknown space is not null, the tiles'
  /// frontiers replace it. `tiles` must outlive the scene.
  void set_tiles(const TileWindow* tiles) { tiles_ = tiles; }
  /// Discards the expected depth. Call after the room's mesh has changed.
  void room_changed() { expected_.camera = {}; }
  /// Returns the previous frame's mask of dynamic pixels, resized to the image size of `camera` by nearest
  /// neighbour. Returns an empty mask if there is no previous frame.
  const MaskImage& previous_dynamic_mask(const Intrinsics& camera);
  /// Labels the frame's pixels from live depth, expected depth and the previous frame's labels.
  const FrameForeground& find_dynamic(const Frame& frame, const ExpectedView& expected);
  /// With kMap, meshes the dynamic pixels and infers the back of the dynamic surface. Pixels in front of space
  /// that the map does not know are meshed, too, as far as they are near `objects`. The mesh has full resolution
  /// in the regions `fine`. With other policies, meshes all pixels.
  /// @param expected, foreground  results of the previous steps for this frame
  void mesh_surfaces(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                     const ExpectedView& expected, const FrameForeground& foreground,
                     std::span<const FineRegion> fine = {}, std::span<const FineRegion> objects = {});
  /// Meshes all pixels. Used by the policies other than kMap, which need no foreground.
  void mesh_all_pixels(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Returns all surfaces that can be touched. With kMap: the room, the dynamic surface, its inferred back,
  /// and the frontier of unknown space. With other policies: the mesh of the frame's pixels.
  [[nodiscard]] std::vector<SceneTree> surfaces() const;
  /// Renders the depth of the room (kMap only) and the frame's mesh from any camera, inside the image
  /// rectangle `rect`. Pixels outside `rect` are unchanged.
  void render_surfaces(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                       const PixelRect& rect, DepthImage& depth_m);

  /// Totals since construction.
  [[nodiscard]] RoomDrawn room_drawn() const { return room_drawn_; }
  /// Cells of the last dynamic mesh, counted by kind and by fine region; kMap only.
  [[nodiscard]] const DynamicCells& dynamic_cells() const { return buffers_.dynamic.cells; }

  /// The last view rendered by render_expected().
  [[nodiscard]] const ExpectedView& expected() const { return expected_; }
  /// The last result of find_dynamic().
  [[nodiscard]] const FrameForeground& foreground() const { return foreground_; }
  [[nodiscard]] const DynamicSurface& dynamic_world() const { return dynamic_world_; }
  /// Points of the dynamic pixels of this frame, and of the frame before it; kMap only.
  [[nodiscard]] std::span<const Eigen::Vector3d> dynamic_points_world() const { return points_world_; }
  [[nodiscard]] std::span<const Eigen::Vector3d> last_dynamic_points_world() const {
    return last_points_world_;
  }
  [[nodiscard]] std::size_t dynamic_triangles() const { return moved_.touched.triangle_count(); }
  [[nodiscard]] std::size_t inferred_triangles() const { return inferred_.triangle_count(); }

 private:
  FrameSceneConfig config_;
  const Shape& room_;
  const TriangleTree* unknown_;
  const TileWindow* tiles_ = nullptr;
  Shape moved_;
  DepthPass depth_pass_;

  ExpectedView expected_;
  RoomDrawn room_drawn_;
  ForegroundState foreground_history_;
  FrameForeground foreground_;
  DynamicSurface dynamic_world_;
  std::vector<Eigen::Vector3d> points_world_, last_points_world_;
  TriangleTree inferred_;  ///< inferred backs; can be touched, but are never drawn
  struct Buffers {
    MaskImage touchable;  ///< pixels to mesh: those that moved, and those in front of unmapped space
    DepthMeshScratch mesh;
    DynamicSurfaceScratch dynamic;
    std::vector<MeshInstance> drawn;
    std::vector<Eigen::AlignedBox3d> hidden_world;  ///< bounds of tiles that are not loaded
  };
  Buffers buffers_;

  /// Sets buffers_.touchable.
  void find_touchable(const Frame& frame, const Eigen::Isometry3d& T_world_camera, const LabelImage& labels,
                      std::span<const FineRegion> objects);
  void add_room(std::vector<MeshInstance>& drawn);
  void hide_unloaded(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m);
};

}  // namespace roomradar
