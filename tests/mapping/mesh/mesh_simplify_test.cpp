// mesh_simplify_test.cpp: few triangles on flat parts, deviation within the bound, no cracks.
#include "mapping/mesh/mesh_simplify.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mapping/mesh/edge_collapse.hpp"
#include "mapping/mesh/mesh_borders.hpp"
#include "mapping/mesh/mesh_distance.hpp"
#include "mapping/mesh/triangle_distance.hpp"
#include "tests/support/edge_counts.hpp"

namespace roomradar::mesh_simplify_test {
namespace {

// 1 cm squares over height(x, y), x and y in 0..size - 1 cm, without those for which missing() returns true.
template <typename Height, typename Missing>
Mesh sheet(int size, const Height& height_m, const Missing& missing) {
  Mesh mesh;
  mesh.origin = {1.0, 2.0, 3.0};
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const float u = 0.01F * static_cast<float>(x), v = 0.01F * static_cast<float>(y);
      mesh.vertices.emplace_back(u, v, height_m(u, v));
      mesh.normals.emplace_back(0.0F, 0.0F, 1.0F);
      mesh.colours.push_back({100, 150, 200});
    }
  const auto vertex = [&](int x, int y) { return static_cast<std::uint32_t>(size * y + x); };
  for (int y = 0; y + 1 < size; ++y)
    for (int x = 0; x + 1 < size; ++x) {
      if (missing(x, y)) continue;
      mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y), vertex(x + 1, y + 1)});
      mesh.triangles.push_back({vertex(x, y), vertex(x + 1, y + 1), vertex(x, y + 1)});
    }
  return mesh;
}

constexpr auto kNothing = [](int, int) { return false; };
constexpr auto kFlat = [](float, float) { return 0.25F; };

double farthest_m(const Mesh& from, const Mesh& to) {
  double farthest = 0.0;
  const auto ask = [&](const Eigen::Vector3f& p) {
    float nearest = 100.0F;
    for (const auto& [a, b, c] : to.triangles)
      nearest =
          std::min(nearest, squared_distance_to_triangle(p, to.vertices[a], to.vertices[b], to.vertices[c]));
    farthest = std::max(farthest, static_cast<double>(std::sqrt(nearest)));
  };
  for (const auto& [i, j, k] : from.triangles) {
    const Eigen::Vector3f a = from.vertices[i], b = from.vertices[j], c = from.vertices[k];
    for (int u = 0; u <= 4; ++u)
      for (int v = 0; u + v <= 4; ++v)
        ask(a + 0.25F * static_cast<float>(u) * (b - a) + 0.25F * static_cast<float>(v) * (c - a));
  }
  return farthest;
}

void expect_whole(const Mesh& mesh) {
  for (const auto& [edge, use] : test::edge_uses(mesh)) {
    ASSERT_LE(use.forward, 1);
    ASSERT_LE(use.backward, 1);
  }
}

TEST(MeshSimplify, AFlatSheetIsAFewTrianglesWithItsHoleAndItsColour) {
  const Mesh fine = sheet(50, kFlat, [](int x, int y) { return x >= 20 && x < 40 && y >= 25 && y < 30; });
  const SimplifiedMesh coarse = simplified(fine, 0.002F, 0.01F);
  EXPECT_LE(coarse.mesh.triangles.size(), 40U);
  EXPECT_LE(coarse.deviation_m, 0.002F);
  expect_whole(coarse.mesh);
  const std::vector<BorderLoop> loops = border_loops(coarse.mesh);
  ASSERT_EQ(loops.size(), 2U);
  EXPECT_TRUE(loops[0].encloses_surface);
  EXPECT_NEAR(loops[0].area_m2, 0.49 * 0.49, 0.005);
  EXPECT_NEAR(loops[1].area_m2, 0.20 * 0.05, 0.001);
  for (const Rgb& colour : coarse.mesh.colours) EXPECT_EQ(colour, (Rgb{100, 150, 200}));
  for (const Eigen::Vector3f& normal : coarse.mesh.normals)
    EXPECT_LT((normal - Eigen::Vector3f::UnitZ()).norm(), 1e-4F);
}

TEST(MeshSimplify, NoPointOfEitherSurfaceIsFartherThanTheBound) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise_m(0.0F, 0.001F);
  const auto bumps = [&](float x, float y) {
    const float step = x > 0.25F ? 0.05F : 0.0F;
    return step + 0.02F * std::sin(25.0F * x) * std::cos(18.0F * y) + noise_m(random);
  };
  const Mesh fine = sheet(40, bumps, [](int x, int y) { return (x * x + 3 * y * y) % 97 == 0; });
  std::size_t before = fine.triangles.size();
  for (const float bound_m : {0.001F, 0.003F, 0.01F}) {
    const SimplifiedMesh coarse = simplified(fine, bound_m, 0.005F);
    EXPECT_LT(coarse.mesh.triangles.size(), before);
    before = coarse.mesh.triangles.size();
    expect_whole(coarse.mesh);
    const double measured_m = std::max(farthest_m(fine, coarse.mesh), farthest_m(coarse.mesh, fine));
    // The bound was checked at sample points; between them the deviation may be slightly larger.
    EXPECT_LE(measured_m, 1.2 * bound_m);
    EXPECT_LE(coarse.deviation_m, bound_m);
    EXPECT_GE(1.4 * coarse.deviation_m, measured_m);
    EXPECT_EQ(border_loops(coarse.mesh).size(), border_loops(fine).size());
  }
  EXPECT_LT(before * 4, fine.triangles.size());
}

TEST(MeshSimplify, ALargeSheetIsDoneInBlocksAndNotTornBetweenThem) {
  std::mt19937 random(7);
  std::normal_distribution<float> noise_m(0.0F, 0.001F);
  const auto bumps = [&](float x, float y) { return 0.02F * std::sin(9.0F * x * y) + noise_m(random); };
  const Mesh fine = sheet(140, bumps, [](int x, int y) { return (x * x + 3 * y * y) % 197 == 0; });
  const SimplifiedMesh coarse = simplified(fine, 0.004F, 0.01F);
  EXPECT_LT(coarse.mesh.triangles.size() * 4, fine.triangles.size());
  EXPECT_GT(coarse.deviation_m, 0.0F);
  EXPECT_LE(coarse.deviation_m, 0.004F);
  std::vector<FarPoint> far;
  static_cast<void>(
      greatest_distance_m(coarse.mesh, MeshDistanceQuery(fine, 0.01F), 0.008F, 1.2F * 0.004F, far));
  static_cast<void>(
      greatest_distance_m(fine, MeshDistanceQuery(coarse.mesh, 0.01F), 0.008F, 1.2F * 0.004F, far));
  EXPECT_TRUE(far.empty());
  expect_whole(coarse.mesh);
  EXPECT_EQ(border_loops(coarse.mesh).size(), border_loops(fine).size());
  const SimplifiedMesh again = simplified(fine, 0.004F, 0.01F);
  EXPECT_EQ(again.mesh.triangles, coarse.mesh.triangles);
  EXPECT_EQ(again.mesh.vertices, coarse.mesh.vertices);
}

class MeshSimplifyBall : public testing::TestWithParam<int> {};

TEST_P(MeshSimplifyBall, AClosedSurfaceStaysClosed) {
  Mesh ball;
  const int rings = GetParam(), sectors = 2 * rings;
  ball.vertices.emplace_back(0.0F, 0.0F, 0.2F);
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < sectors; ++s) {
      const double polar = M_PI * r / rings, azimuth = 2.0 * M_PI * s / sectors;
      ball.vertices.push_back((0.2 * Eigen::Vector3d(std::sin(polar) * std::cos(azimuth),
                                                     std::sin(polar) * std::sin(azimuth), std::cos(polar)))
                                  .cast<float>());
    }
  ball.vertices.emplace_back(0.0F, 0.0F, -0.2F);
  const auto at = [&](int r, int s) {
    return static_cast<std::uint32_t>(1 + (r - 1) * sectors + s % sectors);
  };
  const auto last = static_cast<std::uint32_t>(ball.vertices.size() - 1);
  for (int s = 0; s < sectors; ++s) {
    ball.triangles.push_back({0, at(1, s), at(1, s + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      ball.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      ball.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
    ball.triangles.push_back({at(rings - 1, s), last, at(rings - 1, s + 1)});
  }
  const SimplifiedMesh coarse = simplified(ball, 0.004F, 0.01F);
  EXPECT_LT(coarse.mesh.triangles.size() * 4, ball.triangles.size());
  EXPECT_TRUE(border_loops(coarse.mesh).empty());
  double volume_m3 = 0.0;
  for (const auto& [a, b, c] : coarse.mesh.triangles)
    volume_m3 += coarse.mesh.vertices[a].dot(coarse.mesh.vertices[b].cross(coarse.mesh.vertices[c])) / 6.0;
  EXPECT_NEAR(volume_m3, 4.0 / 3.0 * M_PI * 0.008, 0.05 * 0.0335);
  expect_whole(coarse.mesh);
}

INSTANTIATE_TEST_SUITE_P(InOneBlockAndInMore, MeshSimplifyBall, testing::Values(24, 72));

TEST(MeshSimplify, VerticesThatMayNotMoveGetNoNewEdgeAmongThem) {
  constexpr int kSize = 9;
  const Mesh fine = sheet(kSize, kFlat, kNothing);
  std::vector<float> tolerance_m;
  for (int i = 0; i < kSize * kSize; ++i) {
    const int x = i % kSize, y = i / kSize;
    const bool on_rim = std::min(x, y) == 0 || std::max(x, y) == kSize - 1;
    tolerance_m.push_back(on_rim ? 0.0F : 0.002F);
  }
  const Mesh coarse = collapsed(fine, MeshDistanceQuery(fine, 0.01F), tolerance_m);
  EXPECT_LT(coarse.triangles.size() * 2, fine.triangles.size());
  const auto before = test::edge_uses(fine);
  for (const auto& [edge, use] : test::edge_uses(coarse))
    if (tolerance_m[edge.first] == 0.0F && tolerance_m[edge.second] == 0.0F) {
      EXPECT_EQ(before.count(edge), 1U) << edge.first << " " << edge.second;
    }
}

TEST(MeshSimplify, AlmostNothingIsLeftAsItIs) {
  EXPECT_TRUE(simplified(Mesh{}, 0.001F, 0.01F).mesh.triangles.empty());
  Mesh one;
  one.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  one.triangles = {{0, 1, 2}};
  EXPECT_EQ(simplified(one, 0.5F, 0.1F).mesh.triangles.size(), 1U);
  one.triangles.push_back({0, 1, 2});  // not a manifold: two triangles use an edge in the same direction
  EXPECT_EQ(simplified(one, 0.5F, 0.1F).mesh.triangles.size(), 2U);
}

}  // namespace
}  // namespace roomradar::mesh_simplify_test
