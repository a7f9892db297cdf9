// frame_scene.hpp: the surfaces that virtual objects can touch in a frame: the saved room and the dynamic
// foreground.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <span>
#include <vector>

#include "app/objects/shape.hpp"
#include "dynamic/foreground/foreground.hpp"
#include "dynamic/surface/depth_mesh.hpp"
#include "dynamic/surface/dynamic_surface.hpp"
#include "dynamic/surface/surface_policy.hpp"
#include "mapping/types/frame.hpp"
#include "mapping/types/mesh.hpp"
#include "radar/depth/depth_pass.hpp"
#include "radar/geometry/radar_scene.hpp"
#include "radar/geometry/triangle_tree.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

struct FrameSceneConfig {
  SurfacePolicy surfaces = SurfacePolicy::kMap;
  ForegroundConfig foreground = {};
  DynamicSurfaceConfig moved = {};  ///< used with kMap
  DepthMeshConfig mesh = {};        ///< used with the other policies
};

/// Depth of the static room in a camera's image.
struct ExpectedView {
  Intrinsics camera{};  ///< size 0: nothing rendered so far
  Eigen::Isometry3d T_world_camera = Eigen::Isometry3d::Identity();
  DepthImage depth_m;
  std::size_t triangles = 0;  ///< triangles drawn
};

/// The pixels of a frame, labelled against an expected view.
struct FrameForeground {
  LabelImage labels;
  MaskImage dynamic_mask;  ///< not 0: dynamic
  ForegroundCounts counts;
};

/// The touchable surfaces, rebuilt from each frame in steps; each step takes the previous step's result.
/// Results are references to the scene's buffers, valid until the next call of the same function. Not thread
/// safe.
class FrameScene {
 public:
  /// @param room     static mesh in the world
  /// @param unknown  border of unknown space, which can be touched but is not drawn; null: unknown space is
  ///                 free
  /// Context, room and unknown must outlive the scene. Throws Error if the config is invalid.
  FrameScene(GlContext& context, const Shape& room, const FrameSceneConfig& config,
             const TriangleTree* unknown = nullptr);

  /// Renders the room's depth at a pose. Reuses the last rendering if the view has changed by only a fraction
  /// of a pixel.
  const ExpectedView& render_expected(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera);
  /// Replaces all of the config except `surfaces`, from the next frame on. The config must be valid (not
  /// checked).
  void set_fineness(const FrameSceneConfig& config) {
    config_.foreground = config.foreground;
    config_.moved = config.moved;
    config_.mesh = config.mesh;
  }
  /// Changes which surfaces can be touched, from the next frame on.
  void set_surfaces(SurfacePolicy surfaces);
  /// Replaces the border of unknown space; null: unknown space is free.
  void set_unknown(const TriangleTree* unknown) { unknown_ = unknown; }
  /// Discards the expected depth after the room's shape has changed.
  void room_changed() { expected_.camera = {}; }
  /// Returns the previous frame's mask of dynamic pixels, resized to this camera's image by nearest pixel;
  /// empty if there is none.
  const MaskImage& previous_dynamic_mask(const Intrinsics& camera);
  /// Labels the frame's pixels by the expected depth and the previous frame's labels.
  const FrameForeground& find_dynamic(const Frame& frame, const ExpectedView& expected);
  /// kMap: meshes the dynamic pixels, at full resolution in the given regions, and infers their back. Other
  /// policies mesh all pixels.
  /// @param expected, foreground  of this frame
  void mesh_surfaces(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                     const ExpectedView& expected, const FrameForeground& foreground,
                     std::span<const FineRegion> fine = {});
  /// Meshes all pixels. For policies other than kMap, which need no foreground.
  void mesh_all_pixels(const Frame& frame, const Eigen::Isometry3d& T_world_camera);

  /// Returns all surfaces that can be touched. kMap: the room, the dynamic surface, its inferred back, and
  /// the border of unknown space. Other policies: the frame's own mesh.
  [[nodiscard]] std::vector<SceneTree> surfaces() const;
  /// Renders the depth of the surfaces that can be both touched and seen, from any camera, inside `rect` of
  /// its image. Pixels outside rect are unchanged.
  void render_surfaces(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                       const PixelRect& rect, DepthImage& depth_m);

  /// Number of views that render_expected() has rendered so far, and of room triangles drawn in them.
  struct RoomDrawn {
    std::size_t views = 0, triangles = 0;
  };
  [[nodiscard]] RoomDrawn room_drawn() const { return room_drawn_; }
  /// Cells of the last dynamic mesh, by kind and by region; kMap only.
  [[nodiscard]] const DynamicCells& dynamic_cells() const { return dynamic_scratch_.cells; }

  /// The last view rendered by render_expected().
  [[nodiscard]] const ExpectedView& expected() const { return expected_; }
  /// The last result of find_dynamic().
  [[nodiscard]] const FrameForeground& foreground() const { return foreground_; }
  [[nodiscard]] const DynamicSurface& dynamic_world() const { return dynamic_world_; }
  [[nodiscard]] std::size_t dynamic_triangles() const { return moved_.touched.triangle_count(); }
  [[nodiscard]] std::size_t inferred_triangles() const { return inferred_.triangle_count(); }

 private:
  FrameSceneConfig config_;
  const Shape& room_;
  const TriangleTree* unknown_;
  Shape moved_;
  DepthPass depth_pass_;

  ExpectedView expected_;
  RoomDrawn room_drawn_;
  ForegroundState foreground_history_;
  FrameForeground foreground_;
  DepthMeshScratch mesh_scratch_;
  DynamicSurfaceScratch dynamic_scratch_;
  DynamicSurface dynamic_world_;
  TriangleTree inferred_;  ///< inferred backs; touched, never drawn
};

}  // namespace roomradar
