// object_lod.hpp: levels of detail of a virtual object's mesh.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "app/models/model.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// A simplified mesh. Its two-sided distance to the full mesh is at most deviation_m.
struct LevelOfDetail {
  Mesh mesh;
  float deviation_m = 0.0F;
  /// Per vertex: index of a vertex of the full mesh that was merged into it. Only if seams were kept.
  std::vector<std::uint32_t> full_vertex{};
  // Only of textured models, see textured_lod.hpp:
  std::vector<Eigen::Vector2f> texture_points{};
  std::vector<ModelPart> parts{};
};

/// Computes simplified meshes down to about a hundred triangles, finest first; none for a mesh with fewer
/// than 1,000 triangles. The max deviation starts at 1/1,024 of the mesh's size and grows by a factor of 1.4
/// per level. Levels have normals that reproduce the full mesh's shading (fit_normals.hpp). A full mesh
/// without normals is taken as shaded by vertex normals averaged over the adjacent faces. At faces that
/// deviate from that mean by more than 25 degrees (sharp edges), the face normal is used.
/// @param keeps_seams  vertices at the same position stay separate
std::vector<LevelOfDetail> levels_of_detail(const Mesh& mesh, bool keeps_seams = false);

/// Returns true if a level's deviation is at most error_px pixels; pixel_m is a pixel's size at the object.
inline bool is_fine_enough(float deviation_m, double pixel_m, double error_px) {
  return static_cast<double>(deviation_m) <= error_px * pixel_m;
}

}  // namespace roomradar
