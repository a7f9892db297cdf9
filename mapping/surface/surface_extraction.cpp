// surface_extraction.cpp: smooths the signed distances, extracts the surface, drops small components,
// simplifies.
#include "mapping/surface/surface_extraction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mapping/mesh/components.hpp"
#include "mapping/mesh/mesh_simplify.hpp"
#include "mapping/surface/dual_marching_cubes.hpp"
#include "mapping/surface/surface_parts.hpp"
#include "mapping/surface/tsdf_extrapolation.hpp"
#include "mapping/surface/tsdf_levels.hpp"
#include "mapping/surface/tsdf_smoothing.hpp"
#include "mapping/types/system/config_check.hpp"

namespace roomradar {
namespace {

// Bricks that are extracted at once: takes 110 MB. More than most rooms have.
constexpr std::size_t kMostBricks = 50'000;
constexpr int kSweeps = 6;  // more change the surface by less than 0.1 mm
// Margin around a box in which samples are used; samples beyond move the surface in the box by less than 0.1
// mm.
constexpr double kMargin_voxels = 12.0;
constexpr double kOverlap_voxels = 1.0;
constexpr float kSpacing_voxels = 1.5F;  // spacing of the points at which the deviation is measured

void require_valid(const SurfaceConfig& config) {
  const ConfigCheck rules{"surface"};
  const auto require = [&rules](const char* field, float value) {
    rules(std::isfinite(value) && value >= 0.0F, field, value, "finite and >= 0");
  };
  require("min_weight", config.min_weight);
  require("smoothing", config.smoothing);
  require("min_component_area_m2", config.min_component_area_m2);
  require("max_deviation_m", config.max_deviation_m);
}

// Returns the triangles that have a corner in the box.
std::vector<Triangle> triangles_in(const Mesh& mesh, const Eigen::AlignedBox3d& box_world) {
  const Eigen::AlignedBox3f box((box_world.min() - mesh.origin).cast<float>(),
                                (box_world.max() - mesh.origin).cast<float>());
  std::vector<Triangle> inside;
  for (const Triangle& t : mesh.triangles)
    if (std::any_of(t.begin(), t.end(), [&](std::uint32_t v) { return box.contains(mesh.vertices[v]); }))
      inside.push_back(t);
  return inside;
}

}  // namespace

Mesh extract_full_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                          const SurfaceConfig& config) {
  require_valid(config);
  constexpr int kNodes_voxels = 8, kExtrapolation_voxels = 2, kCell_voxels = 2;
  static_assert(kSurfaceReach_voxels >=
                kSweeps * kReachPerSweep_voxels + kNodes_voxels + kExtrapolation_voxels + 2 * kCell_voxels);
  TsdfLevels levels(map, config.min_weight, box_world);
  if (config.smoothing > 0.0F) smooth(levels, config.smoothing, kSweeps);
  extrapolate_neighbours(levels);
  return dual_marching_cubes(levels, map.resolution_m());
}

SurfacePart extract_surface_part(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                                 const SurfaceConfig& config, SurfaceStats* facts) {
  const double voxel_m = map.resolution_m(), reach_m = kSurfaceReach_voxels * voxel_m;
  Mesh mesh = extract_full_surface(map, grown(box_world, reach_m), config);
  // A component that reaches the end of what is known here goes on beyond it.
  const Eigen::AlignedBox3d known = grown(box_world, reach_m - 4.0 * voxel_m);
  mesh = drop_small_components(std::move(mesh), config.min_component_area_m2,
                               [&](const Eigen::Vector3d& p_world) { return !known.contains(p_world); });
  SurfacePart part = part_in(box_world, std::move(mesh));
  const std::size_t full_triangles = part.mesh.triangles.size();
  float deviation_m = 0.0F;
  if (config.max_deviation_m > 0.0F) {
    SimplifiedMesh simple =
        simplified(std::move(part.mesh), config.max_deviation_m,
                   kSpacing_voxels * static_cast<float>(voxel_m), kBlockTriangles, part.on_seam);
    std::vector<bool> on_seam;
    for (const std::uint32_t v : simple.full_vertex) on_seam.push_back(part.on_seam[v]);
    part = {std::move(simple.mesh), std::move(on_seam)};
    deviation_m = simple.deviation_m;
  }
  if (facts) *facts = {full_triangles, part.mesh.triangles.size(), deviation_m};
  return part;
}

Mesh extract_surface(const StaticMap& map, const SurfaceConfig& config, SurfaceStats* facts) {
  require_valid(config);
  SurfaceStats total;
  Mesh mesh = join_parts(divide(map, kMostBricks), [&](const Eigen::AlignedBox3d& box_world) {
    SurfaceStats stats;
    SurfacePart part = extract_surface_part(map, box_world, config, &stats);
    total.full_triangles += stats.full_triangles;
    total.deviation_m = std::max(total.deviation_m, stats.deviation_m);
    return part;
  });
  total.triangles = mesh.triangles.size();
  if (facts) *facts = total;
  return mesh;
}

Mesh extract_surface(const StaticMap& map, const Eigen::AlignedBox3d& box_world,
                     const SurfaceConfig& config) {
  require_valid(config);
  if (box_world.isEmpty()) return {};
  const double voxel_m = map.resolution_m();
  Mesh mesh = extract_full_surface(map, grown(box_world, kMargin_voxels * voxel_m), config);
  mesh = drop_small_components(std::move(mesh), config.min_component_area_m2);
  mesh.triangles = triangles_in(mesh, grown(box_world, kOverlap_voxels * voxel_m));
  drop_unused_vertices(mesh);
  if (config.max_deviation_m <= 0.0F) return mesh;
  const auto spacing_m = kSpacing_voxels * static_cast<float>(voxel_m);
  return simplified(std::move(mesh), config.max_deviation_m, spacing_m).mesh;
}

}  // namespace roomradar
