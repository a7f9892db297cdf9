// chart_texels.cpp: fills projected triangles.
#include "mapping/texture/chart_texels.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/texture/mesh_raster.hpp"

namespace roomradar {
namespace {

/// Calls visit(x, y) for the texels of the chart whose centres are in the triangle.
template <typename Visit>
void for_each_texel(const Mesh& mesh, const TextureChart& chart, std::uint32_t triangle, const Visit& visit) {
  std::array<Eigen::Vector2f, 3> corners;
  const Eigen::Vector2f first = chart.corner_px.cast<float>();
  for (std::size_t k = 0; k < 3; ++k)
    corners[k] = atlas_point(chart, mesh.vertices[mesh.triangles[triangle][k]]) - first;
  const auto& [a, b, c] = corners;
  const float sign = cross(b - a, c - a) < 0.0F ? -1.0F : 1.0F;
  const auto bound = [](float value, int size) {
    return static_cast<int>(std::clamp(value, 0.0F, static_cast<float>(size)));
  };
  const int left = bound(std::floor(std::min({a.x(), b.x(), c.x()})), chart.size_px.x());
  const int right = bound(std::ceil(std::max({a.x(), b.x(), c.x()})), chart.size_px.x());
  const int top = bound(std::floor(std::min({a.y(), b.y(), c.y()})), chart.size_px.y());
  const int bottom = bound(std::ceil(std::max({a.y(), b.y(), c.y()})), chart.size_px.y());
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const Eigen::Vector2f p(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      if (sign * cross(b - a, p - a) >= 0.0F && sign * cross(c - b, p - b) >= 0.0F &&
          sign * cross(a - c, p - c) >= 0.0F)
        visit(x, y);
    }
}

}  // namespace

void set_size_px(TextureChart& chart) {
  for (int axis = 0; axis < 2; ++axis)
    chart.size_px[axis] =
        static_cast<int>(std::ceil(chart.size_m[axis] / chart.texel_m)) + 1 + 2 * kChartPadding_px;
}

Image<std::uint32_t> triangles_of_texels(const Mesh& mesh, const TextureChart& chart) {
  Image<std::uint32_t> owners(chart.size_px.x(), chart.size_px.y(), kNoTriangle);
  for (const std::uint32_t t : chart.triangles)
    for_each_texel(mesh, chart, t, [&](int x, int y) {
      std::uint32_t& owner = owners.at(x, y);
      if (owner == kNoTriangle) owner = t;
    });
  return owners;
}

std::vector<std::uint32_t> overlapping_triangles(const Mesh& mesh, const TextureChart& chart) {
  TextureChart sized = chart;
  set_size_px(sized);
  Image<std::uint8_t> is_covered(sized.size_px.x(), sized.size_px.y());
  std::vector<std::uint32_t> overlapping;
  for (const std::uint32_t t : chart.triangles) {
    int texels = 0, covered = 0;
    for_each_texel(mesh, sized, t, [&](int x, int y) {
      ++texels;
      covered += is_covered.at(x, y);
    });
    if (covered >= 2 && 10 * covered >= texels && t != chart.triangles.front())
      overlapping.push_back(t);
    else
      for_each_texel(mesh, sized, t, [&](int x, int y) { is_covered.at(x, y) = 1; });
  }
  return overlapping;
}

Eigen::Vector3f weights_at(const Mesh& mesh, const TextureChart& chart, std::uint32_t triangle,
                           const Eigen::Vector2f& p_atlas) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector2f a = atlas_point(chart, mesh.vertices[t[0]]);
  const Eigen::Vector2f ab = atlas_point(chart, mesh.vertices[t[1]]) - a;
  const Eigen::Vector2f ac = atlas_point(chart, mesh.vertices[t[2]]) - a;
  const float area = cross(ab, ac);
  if (!(std::abs(area) > 0.0F)) return {1.0F, 0.0F, 0.0F};
  const float of_b = cross(p_atlas - a, ac) / area, of_c = cross(ab, p_atlas - a) / area;
  return {1.0F - of_b - of_c, of_b, of_c};
}

}  // namespace roomradar
