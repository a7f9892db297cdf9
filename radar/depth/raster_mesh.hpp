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

/// A contiguous range of nearby triangles, with its own copies of the vertices it uses.
struct RasterPiece {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  std::uint32_t first_vertex = 0, vertex_count = 0;
  /// Bounding box of the triangles, relative to the mesh's origin, m.
  Eigen::AlignedBox3f bounds_local;
};

/// The vertices of a piece are contiguous, so each is projected only once, with SIMD.
struct RasterMesh {
  /// Max number of triangles of a piece.
  static constexpr std::uint32_t kPieceTriangles = 256;

  std::vector<RasterPiece> pieces;
  /// Coordinates of the vertices of all pieces, relative to the mesh's origin.
  std::vector<float> x_m, y_m, z_m;
  /// Triangles of all pieces, as indices into their piece's vertices.
  std::vector<PieceTriangle> triangles;

  // Scratch memory.
  ChunkedTriangles chunked;
  // Scratch memory, one value per vertex of the whole mesh.
  std::vector<std::uint32_t> places;
};

/// Cuts triangles into pieces. All triangles must be valid and sorted spatially. Allocates nothing once `out`
/// has held this many triangles.
void cut_into_pieces(std::span<const Eigen::Vector3f> vertices, std::span<const Triangle> triangles,
                     RasterMesh& out);

}  // namespace roomradar
