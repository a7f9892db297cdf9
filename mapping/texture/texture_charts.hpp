// texture_charts.hpp: divides a mesh into nearly flat charts, each with its own rectangle in a texture.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "mapping/types/mesh.hpp"

namespace roomradar {

/// Connected triangles, projected along their mean normal. In the projection, earlier triangles cover less
/// than a tenth, or less than 2 texels, of each triangle.
struct TextureChart {
  std::vector<std::uint32_t> triangles;
  /// Rows: unit vectors along the texture's x and y, in the mesh's frame.
  Eigen::Matrix<float, 2, 3> axes = Eigen::Matrix<float, 2, 3>::Zero();
  Eigen::Vector2f low_m = Eigen::Vector2f::Zero();      ///< lowest coordinates along the axes, m
  Eigen::Vector2f size_m = Eigen::Vector2f::Zero();     ///< extent along the axes, m
  float texel_m = 0.0F;                                 ///< edge of a texel on the surface, m
  Eigen::Vector2i corner_px = Eigen::Vector2i::Zero();  ///< top left texel in the atlas, padding included
  Eigen::Vector2i size_px = Eigen::Vector2i::Zero();    ///< padding included
};

inline constexpr int kChartPadding_px = 2;  ///< on each side of a chart

/// Returns the position of a point (relative to the mesh's origin) in the atlas, in texels. The centre of the
/// texel in the top left corner is at (0.5, 0.5).
inline Eigen::Vector2f atlas_point(const TextureChart& chart, const Eigen::Vector3f& p_local) {
  return (chart.axes * p_local - chart.low_m) / chart.texel_m +
         (chart.corner_px.array() + kChartPadding_px).matrix().cast<float>();
}

/// Grows charts from the largest triangles over neighbours whose normals differ by less than 50 degrees from
/// the chart's mean, to an extent of about a metre. Each triangle is in one chart. A triangle that would
/// overlap others of its chart becomes the seed of another chart. Sets size and axes of the charts, and
/// texel_m from the mean of texels_per_m over the chart's triangles.
/// @param texels_per_m  wanted number of texels per metre, one per triangle, > 0
std::vector<TextureChart> texture_charts(const Mesh& mesh, std::span<const float> texels_per_m);

}  // namespace roomradar
