// depth_pass.hpp: what a depth camera would measure of meshes, without noise.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/depth/depth_raster.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

enum class DepthRenderer {
  kAuto,       ///< OpenGL on a GPU; the processor where OpenGL is software
  kOpenGl,     ///< whatever the context runs on
  kProcessor,  ///< DepthRaster
};

struct DepthPassConfig {
  DepthRenderer renderer = DepthRenderer::kAuto;
  double near_m = 0.1;           ///< nearer surfaces are cut away; a Kinect sees from 0.4 m on
  bool cull_back_faces = false;  ///< true: only triangles that are counter-clockwise seen from the camera
};
/// @throws Error naming the field, its value and the rule
void require_valid(const DepthPassConfig& config);

/// Owns what it draws with, which grows to the largest image asked for. Not thread safe.
class DepthPass {
 public:
  explicit DepthPass(GlContext& context, const DepthPassConfig& config = {});
  ~DepthPass();
  DepthPass(const DepthPass&) = delete;
  DepthPass& operator=(const DepthPass&) = delete;

  /// Renders the nearest surface of all instances, sampled at pixel centres.
  ///
  /// @param scene           meshes with their poses; those with a null mesh are left out
  /// @param camera          of the image to make; if it is not one (require_valid), depth_m comes back empty
  /// @param T_world_camera  camera pose
  /// @param depth_m         gets camera's size; metres along the optical axis, 0 where nothing is
  /// @return triangles handed to the renderer
  /// There is no far end. Error against the exact ray: 1/256 pixel (of vertices that OpenGL snaps, or of
  /// outlines that the processor widens by less) across the surface's slope, and about 1e-7 of the depth
  /// along it; by the processor, of triangles that reach to near_m, 4e-6 / m of inverse depth: 0.3 mm at 8 m.
  std::size_t render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m);

  /// The same for a rectangle of the image only: pixels of `depth_m` outside it stay as they are (if depth_m
  /// has not camera's size it is resized and set to 0 first). Chunks outside the rectangle are not drawn.
  std::size_t render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, const PixelRect& rect, DepthImage& depth_m);

 private:
  DepthPassConfig config_;
  std::unique_ptr<DepthRaster> raster_;  ///< null: OpenGL
  unsigned program_ = 0;
  unsigned framebuffer_ = 0;
  unsigned depth_texture_ = 0;
  int texture_width_px_ = 0;
  int texture_height_px_ = 0;

  void fit_framebuffer(int width_px, int height_px);
  std::size_t render_with_gl(std::span<const MeshInstance> scene, const Intrinsics& camera,
                             const Eigen::Isometry3d& T_world_camera, const PixelRect& rect,
                             DepthImage& depth_m);
};

/// The smallest rectangle of whole pixels that holds the instance's bounding box as the camera sees it; the
/// whole image where the box reaches behind near_m; width and height 0 where it is out of sight.
PixelRect pixels_of(const MeshInstance& instance, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_world_camera, double near_m);

}  // namespace roomradar
