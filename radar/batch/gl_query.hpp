// gl_query.hpp: a query of GlRadar, and its settings.
#pragma once
#include <Eigen/Core>
#include <cstddef>

#include "radar/gl/gpu_mesh.hpp"

namespace roomradar {

/// Processor that computes the minimum over each query's pixels.
enum class GlMinimum {
  /// The GPU if there is one, else the CPU.
  kAuto,
  /// The renderer, by compute shader. A few bytes per query are read back.
  kOnRenderer,
  /// The CPU. All pixels are read back.
  kReadBack,
};

struct GlRadarConfig {
  /// Number of samples along the longer side of the object's bounding rectangle perpendicular to the motion,
  /// 1 to 4096.
  int resolution_px = 128;
  /// In each pixel, surfaces more than this distance behind the object's front surface are ignored.
  double overlap_tolerance_m = 0.03;
  /// Side of the textures shared by many queries, 1 to 16384. Raised to resolution_px, and limited to the
  /// renderer's max texture size.
  int atlas_px = 2048;
  GlMinimum minimum = GlMinimum::kAuto;
  /// True: a query whose lower_m would be 0 for lack of resolution (see GlRadar) gets an exact result from
  /// CyberRadar. Requires a triangle tree (GpuMesh::tree()) for the object and for every mesh that intersects
  /// the query's volume.
  bool exact_fallback = true;
};
/// Checks that all values are in their ranges.
/// @throws Error naming the field, its value and the rule
void require_valid(const GlRadarConfig& config);

/// One query of GlRadar::query_all().
struct GlQuery {
  static constexpr std::size_t kNotInScene = static_cast<std::size_t>(-1);
  /// The moving object.
  MeshInstance object;
  /// Direction of motion; any length except 0.
  Eigen::Vector3d direction_world = Eigen::Vector3d::Zero();
  /// Max distance to search, > 0, at most 10 km.
  double distance_m = 0.0;
  /// Index of the object's own mesh in the scene, which the query skips. kNotInScene if there is none.
  std::size_t own_index = kNotInScene;
};

/// Returns false if GlRadar rejects the query, whatever the scene.
bool is_usable(const GlQuery& query);

}  // namespace roomradar
