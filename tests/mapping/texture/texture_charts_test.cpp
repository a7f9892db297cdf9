// texture_charts_test.cpp: charts cover a mesh once, do not overlap, and fit the atlas.
#include "mapping/texture/texture_charts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "mapping/texture/chart_packing.hpp"
#include "mapping/texture/chart_texels.hpp"
#include "mapping/texture/mesh_raster.hpp"
#include "tests/mapping/texture/texture_scene.hpp"

namespace roomradar::texture_charts_test {
namespace {

/// Cube of 20 cm, two triangles per face.
Mesh cube() {
  Mesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.emplace_back(0.2F * static_cast<float>(i & 1), 0.2F * static_cast<float>(i >> 1 & 1),
                               0.2F * static_cast<float>(i >> 2));
  for (const auto& [a, b, c, d] :
       {std::array{0U, 2U, 3U, 1U}, std::array{4U, 5U, 7U, 6U}, std::array{0U, 1U, 5U, 4U},
        std::array{2U, 6U, 7U, 3U}, std::array{0U, 4U, 6U, 2U}, std::array{1U, 3U, 7U, 5U}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

/// Ramp that winds round the z axis twice: seen from above, its second turn lies over the first.
Mesh ramp() {
  Mesh mesh;
  constexpr std::uint32_t kSteps = 80;
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    const float angle = 4.0F * 3.14159265F * static_cast<float>(i) / kSteps;
    for (const float radius : {0.2F, 0.4F})
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.02F * angle);
  }
  for (std::uint32_t i = 0; i < kSteps; ++i) {
    const std::uint32_t a = 2 * i;
    mesh.triangles.push_back({a, a + 1, a + 3});
    mesh.triangles.push_back({a, a + 3, a + 2});
  }
  return mesh;
}

std::vector<float> even_density(const Mesh& mesh, float texels_per_m) {
  return std::vector<float>(mesh.triangles.size(), texels_per_m);
}

void expect_each_triangle_once(const Mesh& mesh, const std::vector<TextureChart>& charts) {
  std::multiset<std::uint32_t> all;
  for (const TextureChart& chart : charts) all.insert(chart.triangles.begin(), chart.triangles.end());
  ASSERT_EQ(all.size(), mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) EXPECT_EQ(all.count(t), 1U) << t;
}

TEST(TextureCharts, ACubeHasSixCharts) {
  const Mesh mesh = cube();
  const std::vector<TextureChart> charts = texture_charts(mesh, even_density(mesh, 200.0F));
  EXPECT_EQ(charts.size(), 6U);
  expect_each_triangle_once(mesh, charts);
  for (const TextureChart& chart : charts) {
    EXPECT_NEAR(chart.size_m.x(), 0.2F, 1e-5F);
    EXPECT_NEAR(chart.size_m.y(), 0.2F, 1e-5F);
    EXPECT_NEAR(chart.texel_m, 0.005F, 1e-6F);
  }
}

TEST(TextureCharts, ASurfaceThatOverlapsItselfIsSplit) {
  const Mesh mesh = ramp();
  std::vector<TextureChart> charts = texture_charts(mesh, even_density(mesh, 250.0F));
  expect_each_triangle_once(mesh, charts);
  ASSERT_GE(charts.size(), 2U);
  ASSERT_FALSE(pack(charts, 4096).isZero());
  // Each triangle owns the texels at its middle.
  for (const TextureChart& chart : charts) {
    const Image<std::uint32_t> owners = triangles_of_texels(mesh, chart);
    for (const std::uint32_t t : chart.triangles) {
      Eigen::Vector3f middle = Eigen::Vector3f::Zero();
      for (const std::uint32_t vertex : mesh.triangles[t]) middle += mesh.vertices[vertex] / 3.0F;
      const Eigen::Vector2i texel = atlas_point(chart, middle).cast<int>() - chart.corner_px;
      EXPECT_EQ(owners.at(texel.x(), texel.y()), t);
    }
  }
}

TEST(TextureCharts, NoTexelOfAnAtlasBelongsToTwoCharts) {
  const Mesh mesh = cube();
  std::vector<TextureChart> charts = texture_charts(mesh, even_density(mesh, 300.0F));
  const Eigen::Vector2i size_px = pack(charts, 4096);
  Image<int> count(size_px.x(), size_px.y());
  for (const TextureChart& chart : charts)
    for (int y = 0; y < chart.size_px.y(); ++y)
      for (int x = 0; x < chart.size_px.x(); ++x)
        ++count.at(chart.corner_px.x() + x, chart.corner_px.y() + y);
  for (const int charts_there : count.pixels) EXPECT_LE(charts_there, 1);
  for (const TextureChart& chart : charts)
    for (const std::uint32_t t : chart.triangles)
      for (const std::uint32_t vertex : mesh.triangles[t]) {
        const Eigen::Vector2f p = atlas_point(chart, mesh.vertices[vertex]) - chart.corner_px.cast<float>();
        EXPECT_GE(p.minCoeff(), kChartPadding_px - 1e-3F);
        EXPECT_LE((p - chart.size_px.cast<float>()).maxCoeff(), -kChartPadding_px + 1e-3F);
      }
}

TEST(TextureCharts, TexelsGrowUntilTheAtlasIsLargeEnough) {
  const Mesh mesh = cube();
  std::vector<TextureChart> charts = texture_charts(mesh, even_density(mesh, 1000.0F));
  const Eigen::Vector2i size_px = pack(charts, 128);
  EXPECT_LE(size_px.maxCoeff(), 128);
  EXPECT_GT(size_px.minCoeff(), 0);
  EXPECT_GT(charts.front().texel_m, 0.001F);
  EXPECT_LT(charts.front().texel_m, 0.02F);
}

TEST(TextureCharts, TooManyChartsForAnyTexelGiveNoAtlas) {
  std::vector<TextureChart> charts(2000);
  for (TextureChart& chart : charts) {
    chart.axes.setIdentity();
    chart.size_m = {0.01F, 0.01F};
    chart.texel_m = 0.005F;
  }
  EXPECT_TRUE(pack(charts, 64).isZero());
}

TEST(TextureCharts, AnAtlasIsNotMirrored) {
  // Seen from the origin, +y of the wall is to the left and +z is up.
  const Mesh mesh = test::wall_mesh();
  const std::vector<TextureChart> charts = texture_charts(mesh, even_density(mesh, 100.0F));
  ASSERT_GE(charts.size(), 2U);  // 1.2 m is more than the extent of a chart
  for (const TextureChart& chart : charts) {
    const Eigen::Vector3f x = chart.axes.row(0), y = chart.axes.row(1);
    EXPECT_NEAR(x.cross(y).dot(Eigen::Vector3f(-1, 0, 0)), -1.0F, 1e-5F);
  }
}

}  // namespace
}  // namespace roomradar::texture_charts_test
