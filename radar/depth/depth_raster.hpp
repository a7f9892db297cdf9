// depth_raster.hpp: renders depth images of meshes on the CPU, on two threads.
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

/// Which surfaces DepthRaster draws, see DepthPassConfig.
struct RasterRules {
  double near_m = 0.1;
  bool cull_back_faces = false;
};

/// Renders the images of DepthPass without OpenGL, several times as fast as software OpenGL. Two threads
/// divide the meshes' pieces (RasterPiece) between them. Each thread draws on its own canvas, and the nearest
/// surface of both canvases is kept. The result thus does not depend on the assignment of pieces to threads.
/// Not thread safe.
class DepthRaster {
 public:
  /// Renders a rectangle of an image. Parameters are those of DepthPass::render(). `rect`
  /// must lie within the image and have pixels. Allocates nothing once meshes and images of this size have
  /// been drawn.
  std::size_t render(std::span<const MeshInstance> scene, const Intrinsics& camera,
                     const Eigen::Isometry3d& T_world_camera, const PixelRect& rect, const RasterRules& rules,
                     DepthImage& depth_m);

  /// Takes the pieces that cut_into_pieces() made of the mesh's vertices and triangles, possibly on another
  /// thread. Without this call, the pieces are made when the mesh is first drawn, which delays that frame.
  void set_pieces(const GpuMesh& mesh, RasterMesh pieces);

 private:
  /// Matrix from local points to (u * depth, v * depth, depth).
  using Projection = Eigen::Matrix<double, 3, 4>;

  /// A mesh drawn by an earlier call, cut into pieces.
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
    /// Index in visible_meshes_.
    std::uint32_t mesh = 0;
    std::uint32_t piece = 0;
    /// True if the piece must be clipped, since it may reach behind the near plane or far outside the image.
    bool is_cut = false;
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

  /// Returns the entry of a mesh, or one to be filled.
  KnownMesh& known_mesh(const GpuMesh& mesh);
  const RasterMesh& pieces_of(const GpuMesh& mesh);
  std::size_t find_visible(std::span<const MeshInstance> scene, const Intrinsics& camera,
                           const Eigen::Isometry3d& T_world_camera, const PixelRect& rect);
  void paint(Painter& painter);
  void paint_cut(const RasterMesh& mesh, const RasterPiece& piece, const Projection& projection,
                 Painter& painter) const;
};

}  // namespace roomradar
