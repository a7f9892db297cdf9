// frame_scene.hpp: what a virtual object can touch in a frame: the saved room, and what has moved in it.
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
  DynamicSurfaceConfig moved = {};  ///< of kMap
  DepthMeshConfig mesh = {};        ///< of the others
};

/// Made anew from each frame: render_expected, find_dynamic, mesh_dynamic, in this order. Not thread safe.
class FrameScene {
 public:
  /// `room` is the static mesh in the world, `unknown` the surface round space that nobody has seen, which
  /// can be touched but not seen; null: such space is free. They and the context must outlive this. Throws
  /// Error if the config is out of its rules.
  FrameScene(GlContext& context, const Shape& room, const FrameSceneConfig& config,
             const TriangleTree* unknown = nullptr);

  /// The depth that the room shows at a pose; it is kept while the view is the same to a fraction of a pixel.
  /// Returns the triangles drawn for it.
  std::size_t render_expected(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera);
  /// All of it but what can be touched; from the next frame on. The rules must hold.
  void set_fineness(const FrameSceneConfig& config) {
    config_.foreground = config.foreground;
    config_.moved = config.moved;
    config_.mesh = config.mesh;
  }
  /// From the next frame on something else can be touched.
  void set_surfaces(SurfacePolicy surfaces);
  /// Null: space that nobody has seen is free.
  void set_unknown(const TriangleTree* unknown) { unknown_ = unknown; }
  /// The room's shape is another by now.
  void room_changed() { expected_camera_ = {}; }
  /// What moved in the frame before as an image of this camera has it: where its size is another, its nearest
  /// pixels.
  void expect_size(const Intrinsics& camera);
  /// Labels the frame's pixels against the expected depth, and by what the frame before showed.
  ForegroundCounts find_dynamic(const Frame& frame);
  /// kMap: meshes the pixels that moved, as fine as they are in the given regions, and infers their back;
  /// kHoles, kSkirt: all pixels.
  void mesh_dynamic(const Frame& frame, const Eigen::Isometry3d& T_world_camera,
                    std::span<const FineRegion> fine = {});

  /// What can be touched: kMap: the room, what moved and its back, and the border of the unknown; kHoles,
  /// kSkirt: the frame's own mesh.
  [[nodiscard]] std::vector<SceneTree> surfaces() const;
  /// The depth of what can be seen of that, and not of the room alone, as any camera sees it: in `rect` of
  /// its image, the rest of which stays as it is.
  void render_surfaces(const Intrinsics& camera, const Eigen::Isometry3d& T_world_camera,
                       const PixelRect& rect, DepthImage& depth_m);

  /// Views of the room that render_expected() had to draw so far, and its triangles in them.
  struct RoomDrawn {
    std::size_t views = 0, triangles = 0;
  };
  [[nodiscard]] RoomDrawn room_drawn() const { return room_drawn_; }
  /// Of the last frame's mesh of what moved, by kinds and by the regions it was given; kMap only.
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
  Intrinsics expected_camera_;   ///< of no size: nothing was rendered yet
  Eigen::Isometry3d T_world_expected_ = Eigen::Isometry3d::Identity();
  std::size_t expected_triangles_ = 0;
  RoomDrawn room_drawn_;

  ForegroundState foreground_;
  LabelImage labels_;
  MaskImage dynamic_mask_;
  DepthMeshScratch mesh_scratch_;
  DynamicSurfaceScratch dynamic_scratch_;
  DynamicSurface dynamic_world_;
  TriangleTree inferred_;  ///< of the back; touched only
};

}  // namespace roomradar
