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

/// Rebuilt from each frame by render_expected, find_dynamic and mesh_dynamic, in this order. Not thread safe.
class FrameScene {
 public:
  /// @param room     static mesh in the world
  /// @param unknown  border of unknown space, which can be touched but is not drawn; null: unknown space is
  /// free Context, room and unknown must outlive the scene. Throws Error if the config is invalid.
  FrameScene(GlContext& context, const Shape& room, const FrameSceneConfig& config,
             const TriangleTree* unknown = nullptr);

  /// Renders the room's depth at a pose. The rendering is reused while the view is the same within a fraction
  /// of a pixel. Returns the number of triangles drawn for it.
  std::size_t render_expected(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera);
  /// Replaces all of the config except `surfaces`, from the next frame on. The config must be valid (not
  /// checked).
  void set_fineness(const FrameSceneConfig& config) {
    config_.foreground = config.foreground;
    config_.moved = config.moved;
    config_.mesh = config.mesh;
  }
  /// Changes which surfaces can be touched, from the next frame on.
  void set_surfaces(SurfacePolicy surfaces);
  /// Null: unknown space is free.
  void set_unknown(const TriangleTree* unknown) { unknown_ = unknown; }
  /// Discards the expected depth after the room's shape has changed.
  void room_changed() { expected_camera_ = {}; }
  /// Resizes the previous frame's mask of dynamic pixels to this camera's image, by nearest pixel.
  void expect_size(const Intrinsics& camera);
  /// Labels the frame's pixels by the expected depth and the previous frame's labels.
  ForegroundCounts find_dynamic(const Frame& frame);
  /// kMap: meshes the dynamic pixels, at full resolution in the given regions, and infers their back. Other
  /// policies mesh all pixels.
  void mesh_dynamic(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                    std::span<const FineRegion> fine = {});

  /// Returns all surfaces that can be touched. kMap: the room, the dynamic surface, its inferred back, and
  /// the border of unknown space. Other policies: the frame's own mesh.
  [[nodiscard]] std::vector<SceneTree> surfaces() const;
  /// Renders the depth of the surfaces that can be both touched and seen, from any camera, inside `rect` of
  /// its image. Pixels outside rect are unchanged.
  void render_surfaces(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                       const PixelRect& rect, DepthImage& depth_m);

  /// Number of views rendered by render_expected() so far, and the room's triangles drawn in them.
  struct RoomDrawn {
    std::size_t views = 0, triangles = 0;
  };
  [[nodiscard]] RoomDrawn room_drawn() const { return room_drawn_; }
  /// Cells of the last dynamic mesh, by kind and by region; kMap only.
  [[nodiscard]] const DynamicCells& dynamic_cells() const { return dynamic_scratch_.cells; }

  [[nodiscard]] const DepthImage& expected_depth_m() const { return expected_depth_m_; }
  [[nodiscard]] const LabelImage& labels() const { return labels_; }
  [[nodiscard]] const MaskImage& dynamic_mask() const { return dynamic_mask_; }
  [[nodiscard]] const DynamicSurface& dynamic_world() const { return dynamic_world_; }
  [[nodiscard]] std::size_t dynamic_triangles() const { return moved_.touched.triangle_count(); }
  [[nodiscard]] std::size_t inferred_triangles() const { return inferred_.triangle_count(); }

 private:
  FrameSceneConfig config_;
  const Shape& room_;
  const TriangleTree* unknown_;
  Shape moved_;
  DepthPass depth_pass_;

  DepthImage expected_depth_m_;  ///< for expected_camera_ at T_world_expected_
  Intrinsics expected_camera_;   ///< size 0: nothing rendered so far
  Eigen::Isometry3d T_world_expected_ = Eigen::Isometry3d::Identity();
  std::size_t expected_triangles_ = 0;
  RoomDrawn room_drawn_;

  ForegroundState foreground_;
  LabelImage labels_;
  MaskImage dynamic_mask_;
  DepthMeshScratch mesh_scratch_;
  DynamicSurfaceScratch dynamic_scratch_;
  DynamicSurface dynamic_world_;
  TriangleTree inferred_;  ///< inferred backs; touched, never drawn
};

}  // namespace roomradar
