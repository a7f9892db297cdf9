// depth_pass.hpp: renders depth images of meshes, as an ideal depth camera would measure them.
#pragma once
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "radar/depth/depth_raster.hpp"
#include "radar/gl/gl_context.hpp"
#include "radar/gl/gpu_mesh.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

enum class DepthRenderer {
  /// OpenGL if it runs on a GPU, else DepthRaster on the CPU.
  kAuto,
  /// OpenGL, on a GPU or in software.
  kOpenGl,
  /// DepthRaster, on the CPU.
  kProcessor,
};

struct DepthPassConfig {
  DepthRenderer renderer = DepthRenderer::kAuto;
  /// Near plane, > 0; nearer surfaces are clipped. A Kinect measures from 0.4 m.
  double near_m = 0.1;
  /// True: draws only triangles that are counter-clockwise as seen by the camera.
  bool cull_back_faces = false;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const DepthPassConfig& config);

/// Owns its buffers, which grow to the largest image rendered. Not thread safe.
class DepthPass {
 public:
  explicit DepthPass(GlContext& context, const DepthPassConfig& config = {});
  ~DepthPass();
  DepthPass(const DepthPass&) = delete;
  DepthPass& operator=(const DepthPass&) = delete;

  /// Renders the nearest surface of all instances, sampled at pixel centres. There is no far plane.
  ///
  /// The depth error is 1/256 pixel times the surface's slope, since OpenGL snaps vertices (the CPU enlarges
  /// triangles by less), plus about 1e-7 of the depth. On the CPU, a triangle that reaches near_m has an
  /// inverse-depth error of 4e-6 / m, which is 0.3 mm at 8 m.
  ///
  /// @param scene           meshes with their poses; instances with a null mesh are skipped
  /// @param camera          intrinsics of the image; if invalid (require_valid), depth_m becomes empty
  /// @param T_world_camera  camera pose
  /// @param[out] depth_m    resized to the camera's size; metres along the optical axis, 0 if there is no
  ///                        surface
  /// @return number of triangles passed to the renderer
  std::size_t render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, DepthImage& depth_m);

  /// Sets the pieces of a new mesh; see DepthRaster::set_pieces(). Optional. Has no effect if OpenGL renders.
  void set_pieces(const GpuMesh& mesh, RasterMesh pieces) {
    if (raster_) raster_->set_pieces(mesh, std::move(pieces));
  }

  /// Renders only a rectangle of the image. Pixels of `depth_m` outside it are unchanged. If depth_m does not
  /// have the camera's size, it is first resized and set to 0. Chunks of meshes (contiguous ranges of
  /// triangles) outside the rectangle are not drawn.
  std::size_t render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, const PixelRect& rect, DepthImage& depth_m);

 private:
  DepthPassConfig config_;
  /// Null if OpenGL renders.
  std::unique_ptr<DepthRaster> raster_;
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

/// Returns a rectangle of whole pixels that contains the projection of the instance's bounding box into the
/// image; see pixels_of() in projection.hpp. Width and height are 0 if the instance has no mesh.
PixelRect pixels_of(const MeshInstance& instance, const Intrinsics& camera,
                    const Eigen::Isometry3d& T_world_camera, double near_m);

}  // namespace roomradar
