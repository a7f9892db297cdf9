// depth_raster.hpp: CPU renderer of depth images of meshes, on two threads.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "mapping/types/image.hpp"
#include "mapping/types/intrinsics.hpp"
#include "mapping/types/system/worker_thread.hpp"
#include "radar/depth/depth_canvas.hpp"
#include "radar/depth/raster_mesh.hpp"
#include "radar/gl/gpu_mesh.hpp"
#include "radar/gl/projection.hpp"

namespace roomradar {

/// Renders the images of DepthPass without OpenGL. Several times as fast as a software OpenGL, whose cost per
/// triangle is too high for images this small. Two threads share the pieces of the meshes, each with its own
/// canvas. The nearest surface wins, so the result does not depend on which thread drew it. Not thread safe.
class DepthRaster {
 public:
  /// Parameters as for DepthPass::render() and its config; `rect` must lie within the image and have pixels.
  /// Allocates nothing once meshes and images as large were drawn.
  std::size_t render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, const PixelRect& rect, double near_m,
                     bool cull_back_faces, DepthImage& depth_m);

 private:
  using Projection = Eigen::Matrix<double, 3, 4>;  ///< local points to (u * depth, v * depth, depth)

  struct KnownMesh {
    const GpuMesh* mesh = nullptr;
    std::uint64_t revision = 0;
    std::uint64_t last_drawn = 0;
    RasterMesh pieces;
  };
  struct VisibleMesh {
    const RasterMesh* mesh = nullptr;
    Projection projection;
  };
  struct VisiblePiece {
    std::uint32_t mesh = 0;  ///< index in visible_meshes_
    std::uint32_t piece = 0;
    bool is_cut = false;  ///< needs clipping: may reach behind the near plane or far outside the image
  };
  /// Buffers of one thread.
  struct Painter {
    DepthCanvas canvas;
    ProjectedVertices vertices;
    TriangleSetup setup;
    std::vector<PieceTriangle> clipped;
  };

  WorkerThread second_;
  std::array<Painter, 2> painters_;
  std::vector<std::unique_ptr<KnownMesh>> known_;
  std::vector<VisibleMesh> visible_meshes_;
  std::vector<VisiblePiece> visible_pieces_;
  std::atomic<std::size_t> next_piece_{0};
  std::uint64_t drawings_ = 0;
  int width_px_ = 0, height_px_ = 0;
  double near_m_ = 0.0;
  bool cull_back_faces_ = false;

  const RasterMesh& pieces_of(const GpuMesh& mesh);
  std::size_t find_visible(std::span<const MeshInstance> scene, const Intrinsics& camera,
                           const Eigen::Isometry3d& T_world_camera, const PixelRect& rect);
  void paint(Painter& painter);
  void paint_cut(const RasterMesh& mesh, const RasterPiece& piece, const Projection& projection,
                 Painter& painter) const;
};

}  // namespace roomradar
