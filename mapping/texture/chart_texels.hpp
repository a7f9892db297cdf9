// chart_texels.hpp: the texels of a chart, and the point of the surface that each of them shows.
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

/// Returns the triangle at the centre of each texel of a chart, in an image of chart.size_px; kNoTriangle:
/// none. Where triangles overlap, the first in the chart's order.
Image<std::uint32_t> triangles_of_texels(const Mesh& mesh, const TextureChart& chart);

/// Returns the triangles of which a tenth or more, and at least 2 texels, are covered by an earlier one of
/// the chart. Their texels have the size chart.texel_m.
std::vector<std::uint32_t> overlapping_triangles(const Mesh& mesh, const TextureChart& chart);

/// Returns the weights of the triangle's vertices at a point of the atlas, see atlas_point(). They sum to 1.
Eigen::Vector3f weights_at(const Mesh& mesh, const TextureChart& chart, std::uint32_t triangle,
                           const Eigen::Vector2f& p_atlas);

}  // namespace roomradar
