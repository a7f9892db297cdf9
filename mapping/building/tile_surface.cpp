// tile_surface.cpp: extracts with a margin, keeps the tile's triangles, simplifies between the seams.
#include "mapping/building/tile_surface.hpp"

#include <utility>
#include <vector>

#include "mapping/mesh/components.hpp"
#include "mapping/mesh/mesh_simplify.hpp"
#include "mapping/surface/surface_parts.hpp"

namespace roomradar {
namespace {

constexpr float kSpacing_voxels = 1.5F;  // spacing of the points at which the deviation is measured

}  // namespace

Mesh extract_tile_surface(const StaticMap& map, const TileGrid& grid, const TileIndex& tile,
                          const SurfaceConfig& config) {
  const Eigen::AlignedBox3d box = box_of(grid, tile);
  const double reach_m = kSurfaceReach_voxels * grid.resolution_m;
  Mesh mesh = extract_full_surface(map, grown(box, reach_m), config);

  // A component that reaches the end of what is known here goes on beyond it.
  const Eigen::AlignedBox3d known = grown(box, reach_m - 4.0 * grid.resolution_m);
  const auto is_cut = [&](const Eigen::Vector3d& p_world) { return !known.contains(p_world); };
  mesh = drop_small_components(std::move(mesh), config.min_component_area_m2, is_cut);

  std::vector<Triangle> own;
  std::vector<bool> is_others(mesh.vertices.size(), false);
  for (const Triangle& t : mesh.triangles) {
    if (tile_at(grid, centre_world(mesh, t)) == tile)
      own.push_back(t);
    else
      for (const std::uint32_t v : t) is_others[v] = true;
  }
  mesh.triangles = std::move(own);
  std::vector<bool> on_seam;  // by vertex of the tile
  for (const std::uint32_t v : drop_unused_vertices(mesh)) on_seam.push_back(is_others[v]);
  if (config.max_deviation_m <= 0.0F) return mesh;
  const auto spacing_m = kSpacing_voxels * static_cast<float>(grid.resolution_m);
  return simplified(std::move(mesh), config.max_deviation_m, spacing_m, kBlockTriangles, std::move(on_seam))
      .mesh;
}

}  // namespace roomradar
