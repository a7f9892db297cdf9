// gl_query.hpp: a query of GlRadar, and its settings.
#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Processor that computes the least gap of a query.
enum class GlMinimum {
  kAuto,        ///< GPU if there is one, CPU with the software renderer
  kOnRenderer,  ///< compute shader; a few bytes per query are read back
  kReadBack,    ///< CPU; all pixels are read back
};

struct GlRadarConfig {
  int resolution_px = 128;            ///< samples along the longer side of the object's outline, 1 to 4096
  double overlap_tolerance_m = 0.03;  ///< deeper surfaces count as behind the object and are ignored
  int atlas_px = 2048;                ///< side of the textures shared by many queries, 1 to 16384
  GlMinimum minimum = GlMinimum::kAuto;
  /// Runs CyberRadar for an exact result where the two passes cannot decide (see GlRadar), if all meshes that
  /// reach the query's volume share a tree (GpuMesh::tree()).
  bool exact_fallback = true;
};
/// @throws Error naming the field, its value and the rule
void require_valid(const GlRadarConfig& config);

/// One query of GlRadar::query_all().
struct GlQuery {
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
  MeshInstance object;
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();  ///< any length but 0
  double distance_m = 0.0;                                    ///< max distance to search, > 0, at most 10 km
  /// Index of the object itself in the scene, which is skipped.
  std::size_t own_index = kNotInScene;
};

/// Returns false for a query that GlRadar rejects by itself, whatever the scene.
bool is_usable(const GlQuery& query);

}  // namespace roomradar
