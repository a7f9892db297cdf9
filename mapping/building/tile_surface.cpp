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
  Mesh full = extract_full_surface(map, grown(box, reach_m), config);

  // A component that reaches the end of what is known here goes on beyond it.
  const Eigen::AlignedBox3d known = grown(box, reach_m - 4.0 * grid.resolution_m);
  const auto is_cut = [&](std::uint32_t v) {
    return !known.contains(full.origin + full.vertices[v].cast<double>());
  };
  full = drop_small_components(full, config.min_component_area_m2, is_cut);

  std::vector<Triangle> own;
  std::vector<bool> is_others(full.vertices.size(), false);
  for (const Triangle& t : full.triangles) {
    if (tile_at(grid, centre_world(full, t)) == tile)
      own.push_back(t);
    else
      for (const std::uint32_t v : t) is_others[v] = true;
  }
  std::vector<bool> on_seam;  // by vertex of the tile, in the order of compacted()
  std::vector<bool> is_known(full.vertices.size(), false);
  for (const Triangle& t : own)
    for (const std::uint32_t v : t) {
      if (!is_known[v]) on_seam.push_back(is_others[v]);
      is_known[v] = true;
    }
  Mesh mesh = compacted(full, own);
  if (config.max_deviation_m <= 0.0F) return mesh;
  const auto spacing_m = kSpacing_voxels * static_cast<float>(grid.resolution_m);
  return simplified(std::move(mesh), config.max_deviation_m, spacing_m, kBlockTriangles, std::move(on_seam))
      .mesh;
}

}  // namespace roomradar
