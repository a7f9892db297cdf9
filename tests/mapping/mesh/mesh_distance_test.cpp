// mesh_distance_test.cpp: the fast distance to a mesh against a brute-force one.
#include "mapping/mesh/mesh_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "mapping/mesh/triangle_distance.hpp"

namespace roomradar::mesh_distance_test {
namespace {

Eigen::Vector3f point_in(std::mt19937& random, float edge_m) {
  std::uniform_real_distribution<float> along(0.0F, edge_m);
  const float x = along(random), y = along(random), z = along(random);
  return {x, y, z};
}

// Small triangles, and some that span the room.
Mesh random_triangles(std::mt19937& random) {
  Mesh mesh;
  for (std::uint32_t t = 0; t < 300; ++t) {
    const Eigen::Vector3f corner = point_in(random, 1.0F);
    const float size_m = t % 50 == 0 ? 1.0F : 0.05F;
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(corner + point_in(random, size_m));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

TEST(TriangleDistance, AgreesWithADenseLatticeOfPoints) {
  std::mt19937 random(1);
  for (int n = 0; n < 200; ++n) {
    const Eigen::Vector3f a = point_in(random, 1.0F), b = point_in(random, 1.0F), c = point_in(random, 1.0F),
                          p = 3.0F * point_in(random, 1.0F) - Eigen::Vector3f::Ones();
    float nearest = 100.0F;
    for (int i = 0; i <= 100; ++i)
      for (int j = 0; i + j <= 100; ++j)
        nearest = std::min(nearest, (p - a - 0.01F * static_cast<float>(i) * (b - a) -
                                     0.01F * static_cast<float>(j) * (c - a))
                                        .norm());
    const float distance = std::sqrt(squared_distance_to_triangle(p, a, b, c));
    ASSERT_LE(distance, nearest + 1e-5F);
    ASSERT_GE(distance, nearest - 0.01F);
  }
  // Degenerate triangles: a segment, a point.
  EXPECT_FLOAT_EQ(squared_distance_to_triangle({0.5F, 2, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}), 4.0F);
  EXPECT_FLOAT_EQ(squared_distance_to_triangle({0, 2, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}), 4.0F);
}

TEST(TriangleDistance, OfTrianglesWithCornersInOnePlaceIsThatOfTheirSide) {
  std::mt19937 random(4);
  for (const float apart : {0.0F, 1e-8F, 1e-6F})
    for (int n = 0; n < 300; ++n) {
      const Eigen::Vector3f a = point_in(random, 1.0F), b = a + 0.01F * point_in(random, 1.0F);
      const Eigen::Vector3f beside_a = a + apart * point_in(random, 1.0F);
      const Eigen::Vector3f on_side = a + 0.5F * (b - a);
      EXPECT_LT(squared_distance_to_triangle(on_side, a, beside_a, b), 1e-10F);
      EXPECT_LT(squared_distance_to_triangle(on_side, beside_a, b, a), 1e-10F);
      EXPECT_LT(squared_distance_to_triangle(on_side, b, a, beside_a), 1e-10F);
    }
}

TEST(MeshDistanceQuery, FindsWhatAskingEveryTriangleFinds) {
  std::mt19937 random(2);
  const Mesh mesh = random_triangles(random);
  const float reach_m = 0.04F;
  const MeshDistanceQuery surface(mesh, reach_m);
  int within = 0;
  for (int n = 0; n < 3000; ++n) {
    const Eigen::Vector3f p = 1.4F * point_in(random, 1.0F) - Eigen::Vector3f::Constant(0.2F);
    float nearest = 100.0F;
    for (const auto& [a, b, c] : mesh.triangles)
      nearest = std::min(
          nearest, squared_distance_to_triangle(p, mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]));
    nearest = std::sqrt(nearest);
    const float found = surface.distance_m(p);
    if (nearest > reach_m) {
      ASSERT_TRUE(std::isinf(found));
      continue;
    }
    ++within;
    ASSERT_FLOAT_EQ(found, nearest);
    ASSERT_LE(surface.distance_m(p, nearest + 0.001F), nearest + 0.001F);
  }
  EXPECT_GT(within, 100);
}

TEST(MeshDistanceQuery, AGuessAndTheReachChangeNoAnswer) {
  std::mt19937 random(5);
  const Mesh mesh = random_triangles(random);
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  for (const float reach_m : {0.002F, 0.04F, 0.3F, 5.0F}) {
    const MeshDistanceQuery surface(mesh, reach_m);
    std::uint32_t guess = MeshDistanceQuery::kNoGuess, guess_facing = guess;
    int within = 0, facing_it = 0;
    for (int n = 0; n < 500; ++n) {
      const Eigen::Vector3f p = 1.4F * point_in(random, 1.0F) - Eigen::Vector3f::Constant(0.2F);
      const Eigen::Vector3f facing = point_in(random, 1.0F) - Eigen::Vector3f::Constant(0.5F);
      float nearest = reach_m * reach_m, nearest_facing = nearest;
      bool is_found = false, is_facing_found = false;
      for (const auto& [i, j, k] : mesh.triangles) {
        const Eigen::Vector3f &a = mesh.vertices[i], &b = mesh.vertices[j], &c = mesh.vertices[k];
        const float distance = squared_distance_to_triangle(p, a, b, c);
        if (distance <= nearest) nearest = distance, is_found = true;
        if (distance <= nearest_facing && (b - a).cross(c - a).dot(facing) > 0.0F)
          nearest_facing = distance, is_facing_found = true;
      }
      if (n % 3 == 0) guess = guess_facing = static_cast<std::uint32_t>(random()) % count;  // a bad one
      const float found = surface.distance_m(p, 0.0F, guess);
      ASSERT_EQ(std::isfinite(found), is_found);
      ASSERT_EQ(found, surface.distance_m(p));
      if (is_found) {
        ASSERT_FLOAT_EQ(found, std::sqrt(nearest));
        ++within;
      }
      const auto triangle = surface.nearest_facing(p, facing, guess_facing);
      ASSERT_EQ(triangle.has_value(), is_facing_found);
      if (!triangle) continue;
      const auto& [i, j, k] = mesh.triangles[*triangle];
      ASSERT_EQ(squared_distance_to_triangle(p, mesh.vertices[i], mesh.vertices[j], mesh.vertices[k]),
                nearest_facing);
      ASSERT_EQ(guess_facing, *triangle);
      ++facing_it;
    }
    EXPECT_GT(within, reach_m > 0.01F ? 20 : -1);
    EXPECT_GT(facing_it, reach_m > 0.01F ? 10 : -1);
  }
}

// A reach of a millionth of the triangles' size, or below float resolution, leads neither to countless cubes
// nor to endless halving.
TEST(MeshDistanceQuery, AnswersWithinAReachThatIsNextToNothing) {
  std::mt19937 random(3);
  Mesh mesh = random_triangles(random);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Eigen::Vector3f& corner : {Eigen::Vector3f(-20, 0, 3), {30, 0, 3}, {0, 40, 3}})
    mesh.vertices.push_back(corner);
  mesh.triangles.push_back({first, first + 1, first + 2});
  for (const float reach_m : {1e-5F, 1e-8F, 1e-30F}) {
    const MeshDistanceQuery surface(mesh, reach_m);
    EXPECT_EQ(surface.distance_m(mesh.vertices.front()), 0.0F);
    EXPECT_EQ(surface.distance_m(mesh.vertices.back()), 0.0F);
    EXPECT_TRUE(std::isinf(surface.distance_m({0.0F, 10.0F, 3.1F})));
  }
}

TEST(MeshDistance, AMeshIsOnItselfAndALiftedOneIsNot) {
  std::mt19937 random(4);
  Mesh mesh = random_triangles(random);
  const MeshDistanceQuery surface(mesh, 0.01F);
  std::vector<FarPoint> far;
  EXPECT_LT(greatest_distance_m(mesh, surface, 0.01F, 0.005F, far), 1e-5F);
  EXPECT_TRUE(far.empty());
  Mesh lifted = mesh;
  for (Eigen::Vector3f& vertex : lifted.vertices) vertex.z() += 10.0F;
  greatest_distance_m(lifted, surface, 0.01F, 0.005F, far);
  EXPECT_GT(far.size(), lifted.vertices.size());
  EXPECT_TRUE(std::isinf(MeshDistanceQuery(Mesh{}, 0.01F).distance_m({0, 0, 0})));
}

}  // namespace
}  // namespace roomradar::mesh_distance_test
