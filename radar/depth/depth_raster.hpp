// depth_raster.hpp: the depth of meshes as a camera sees them, drawn by the processor on two threads.
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

/// Draws what DepthPass draws with OpenGL, without it: several times as fast as a software renderer, whose
/// effort a triangle is much greater than these few pixels need. Pieces of the meshes are dealt to two
/// threads, each with a canvas of its own; the nearest surface wins, so that the answer does not depend on
/// which thread drew what. Not thread safe.
class DepthRaster {
 public:
  /// Parameters are those of DepthPass::render and its config; `rect` lies within the image and has pixels.
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
    std::uint32_t mesh = 0;  ///< in visible_meshes_
    std::uint32_t piece = 0;
    bool is_cut = false;  ///< may reach behind the near plane, or very far aside
  };
  /// What one thread draws with.
  struct Painter {
    DepthCanvas canvas;
    ProjectedVertices vertices;
    TriangleSetup setup;
    std::vector<PieceTriangle> clipped;
  };

  SecondThread second_;
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
