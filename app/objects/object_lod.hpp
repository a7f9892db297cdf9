// object_lod.hpp: levels of detail of a virtual object's mesh, with normals fitted to the full mesh and its
// textures.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "app/models/model.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A simplified mesh. Its two-sided distance to the full mesh is at most deviation_m.
struct LevelOfDetail {
  Mesh mesh;
  float deviation_m = 0.0F;
  /// Per vertex: index of one of the full mesh's vertices that were merged into it. Empty unless keeps_seams.
  std::vector<std::uint32_t> full_vertex{};
  // Filled only for textured models, see levels_of_detail(const Model&):
  std::vector<Eigen::Vector2f> texture_points{};
  std::vector<ModelPart> parts{};
};

/// Computes simplified meshes, finest first. The last has about 100 triangles, or a deviation of up to 1/8 of
/// the mesh's size (the diagonal of its bounding box). Returns none for a mesh that is invalid or has fewer
/// than 1,000 triangles. The max deviation starts at 1/1,024 of the mesh's size and grows by a factor of 1.4
/// per level. The levels' normals are fitted to the full mesh's normals (fit_normals()). For a full mesh
/// without normals, vertex normals are averaged over adjacent faces. A face that deviates from the averaged
/// normal by more than 25 degrees keeps its own normal. This preserves sharp edges.
/// @param keeps_seams  true: coincident vertices, as along texture seams, are not merged
std::vector<LevelOfDetail> levels_of_detail(const Mesh& mesh, bool keeps_seams = false);

/// Returns true if a level's deviation is at most error_px pixels. pixel_m is the width of one pixel at the
/// object's distance, m.
inline bool is_fine_enough(float deviation_m, double pixel_m, double error_px) {
  return static_cast<double>(deviation_m) <= error_px * pixel_m;
}

/// Computes the levels of detail of a model as levels_of_detail(const Mesh&) does, and transfers texture
/// coordinates, colours and parts to them. Coincident vertices along texture seams are not merged, and each
/// side of a seam keeps its own texture coordinates. On 95 % of a level's area, the texture is shifted along
/// the surface by at most deviation_m. The shift is measured at the centres of triangles and edges.
std::vector<LevelOfDetail> levels_of_detail(const Model& model);

/// Sets the vertex normals of the coarse mesh by linear least squares. The residuals are the differences
/// between fine normals, at sample points of the fine surface, and normals interpolated on the coarse
/// triangles. The correspondence of a sample point is the nearest coarse triangle that faces the same side.
/// Averages of merged vertex normals would shade the simplified mesh too flat. Vertices without
/// correspondences in their triangles keep their normals.
///
/// @param fine       with normals; normals that are not finite are ignored
/// @param reach_m    max distance (> 0) of a sample point from its corresponding triangle
/// @param spacing_m  max distance (> 0) between sample points on a fine triangle. A triangle whose longest
///                   side is at most spacing_m has one. A side is divided into at most 64 parts
/// @param coarse     with normals; Mesh::origin must equal that of `fine`
void fit_normals(const Mesh& fine, float reach_m, float spacing_m, Mesh& coarse);

}  // namespace roomradar
