// raster_mesh.hpp: a mesh cut into small pieces with their own vertices, for the CPU rasteriser.
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"
#include "radar/depth/depth_canvas.hpp"
#include "radar/gl/mesh_chunks.hpp"

namespace roomradar {

/// A run of nearby triangles, and the vertices that only they use.
struct RasterPiece {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  Eigen::AlignedBox3f bounds_local;  ///< m, relative to the mesh's origin
};

/// Vertices of a piece are contiguous, so each is projected once, with SIMD.
struct RasterMesh {
  static constexpr std::uint32_t kPieceTriangles = 256;

  std::vector<RasterPiece> pieces;
  std::vector<float> x_m, y_m, z_m;      ///< vertices of all pieces, local
  std::vector<PieceTriangle> triangles;  ///< indices into their piece's vertices

  ChunkedTriangles chunked;           // scratch
  std::vector<std::uint32_t> places;  // scratch, by vertex of the whole mesh
};

/// Cuts triangles into pieces. All triangles must be usable and in an order that keeps neighbours together.
/// Allocates nothing once `out` has had as many.
void cut_into_pieces(std::span<const Eigen::Vector3f> vertices, std::span<const Triangle> triangles,
                     RasterMesh& out);

}  // namespace roomradar
