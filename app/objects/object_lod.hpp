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
  /// Per vertex: index of one of the full mesh's vertices that were merged into it. Empty unless keeps_seams.
  std::vector<std::uint32_t> full_vertex{};
  // Filled only for textured models, see textured_lod.hpp:
  std::vector<Eigen::Vector2f> texture_points{};
  std::vector<ModelPart> parts{};
};

/// Computes simplified meshes, finest first. The last has about 100 triangles, or a deviation of up to 1/8 of
/// the mesh's size (the diagonal of its bounding box). Returns none for a mesh that is invalid or has fewer
/// than 1,000 triangles. The max deviation starts at 1/1,024 of the mesh's size and grows by a factor of 1.4
/// per level. The levels' normals are fitted to the full mesh's normals (fit_normals.hpp). For a full mesh
/// without normals, vertex normals are averaged over adjacent faces. A face that deviates from the averaged
/// normal by more than 25 degrees keeps its own normal. This preserves sharp edges.
/// @param keeps_seams  true: coincident vertices, as along texture seams, are not merged
std::vector<LevelOfDetail> levels_of_detail(const Mesh& mesh, bool keeps_seams = false);

/// Returns true if a level's deviation is at most error_px pixels. pixel_m is the width of one pixel at the
/// object's distance, m.
inline bool is_fine_enough(float deviation_m, double pixel_m, double error_px) {
  return static_cast<double>(deviation_m) <= error_px * pixel_m;
}

}  // namespace roomradar
