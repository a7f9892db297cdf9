// chart_texels.hpp: rasterises a chart's triangles into its texels, and computes barycentric coordinates in
// the atlas.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mapping/texture/texture_charts.hpp"
#include "mapping/types/image.hpp"
#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Sets TextureChart::size_px from size_m and texel_m.
void set_size_px(TextureChart& chart);

/// Returns an image of chart.size_px with the index of the triangle at each texel's centre; kNoTriangle:
/// none. Where triangles overlap, takes the first in the chart's order.
Image<std::uint32_t> triangles_of_texels(const Mesh& mesh, const TextureChart& chart);

/// Returns the triangles of which at least a tenth, and at least 2 texels of size chart.texel_m, are covered
/// by earlier triangles of the chart.
std::vector<std::uint32_t> overlapping_triangles(const Mesh& mesh, const TextureChart& chart);

/// Returns the barycentric coordinates of a point of the atlas (see atlas_point()) in a triangle; (1, 0, 0)
/// for a triangle without area.
Eigen::Vector3f weights_at(const Mesh& mesh, const TextureChart& chart, std::uint32_t triangle,
                           const Eigen::Vector2f& p_atlas);

}  // namespace roomradar
