// raster_mesh.cpp: gives each run of triangles its own copy of the vertices that it uses.
#include "radar/depth/raster_mesh.hpp"

namespace roomradar {

void cut_into_pieces(std::span<const Eigen::Vector3f> vertices, std::span<const Triangle> triangles,
                     RasterMesh& out) {
  cut_into_chunks(vertices, triangles, RasterMesh::kPieceTriangles, out.chunked);
  out.pieces.clear();
  out.x_m.clear(), out.y_m.clear(), out.z_m.clear();
  out.triangles.resize(triangles.size());
  // Per vertex: its latest index among all pieces' vertices. The index belongs to the current piece if it is
  // at least the piece's first vertex.
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  out.places.assign(vertices.size(), kNone);
  for (const MeshChunk& chunk : out.chunked.chunks) {
    RasterPiece piece;
    piece.first_triangle = chunk.first_triangle;
    piece.triangle_count = chunk.triangle_count;
    piece.first_vertex = static_cast<std::uint32_t>(out.x_m.size());
    piece.bounds_local = chunk.bounds_local;
    for (std::size_t t = chunk.first_triangle; t < chunk.first_triangle + chunk.triangle_count; ++t) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        std::uint32_t& place = out.places[triangles[t][corner]];
        if (place == kNone || place < piece.first_vertex) {
          place = static_cast<std::uint32_t>(out.x_m.size());
          const Eigen::Vector3f& p = vertices[triangles[t][corner]];
          out.x_m.push_back(p.x()), out.y_m.push_back(p.y()), out.z_m.push_back(p.z());
        }
        out.triangles[t][corner] = static_cast<std::uint16_t>(place - piece.first_vertex);
      }
    }
    piece.vertex_count = static_cast<std::uint32_t>(out.x_m.size()) - piece.first_vertex;
    out.pieces.push_back(piece);
  }
}

}  // namespace roomradar
