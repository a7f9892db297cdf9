// fit_normals_test.cpp: fitted normals are as close to the fine mesh's as a mean over each triangle allows.
#include "app/objects/object_lod.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace roomradar::fit_normals_test {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A square of 1 x 1 m at height z_m, n x n cells, with normals from normal_at(x, y).
template <typename NormalAt>
Mesh square(int n, float z_m, const NormalAt& normal_at, bool is_facing_up = true) {
  Mesh mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(n);
      const float y = static_cast<float>(j) / static_cast<float>(n);
      mesh.vertices.emplace_back(x, y, z_m);
      mesh.normals.push_back(Eigen::Vector3f(normal_at(x, y)).normalized());
    }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      Triangle one{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, other{at(i, j), at(i + 1, j + 1), at(i, j + 1)};
      if (!is_facing_up) std::swap(one[1], one[2]), std::swap(other[1], other[2]);
      mesh.triangles.push_back(one);
      mesh.triangles.push_back(other);
    }
  return mesh;
}

const auto upright = [](float, float) { return Eigen::Vector3f::UnitZ(); };

float degrees_between(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 57.29578F;
}

/// Max error of the normals of a square of coarse_n cells, fitted to those of a square of fine_n cells whose
/// slopes change linearly, by at most 0.1 over the square.
float farthest_off_deg(int fine_n, int coarse_n, float spacing_m) {
  const auto bent = [](float x, float y) { return Eigen::Vector3f(0.1F * x, -0.1F * y, 1.0F); };
  Mesh coarse = square(coarse_n, 0.01F, upright);
  fit_normals(square(fine_n, 0.0F, bent), 0.02F, spacing_m, coarse);
  float farthest_deg = 0.0F;
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v)
    farthest_deg =
        std::max(farthest_deg,
                 degrees_between(coarse.normals[v], bent(coarse.vertices[v].x(), coarse.vertices[v].y())));
  return farthest_deg;
}

TEST(FitNormals, AreThoseOfTheFineMeshWhereTheyChangeEvenly) {
  EXPECT_LT(farthest_off_deg(40, 2, 0.1F), 0.2F);
}

TEST(FitNormals, AFewLargeTrianglesOfTheFineMeshTellAsMuchAsManySmallOnes) {
  EXPECT_LT(farthest_off_deg(1, 4, 0.05F), 0.3F);
}

TEST(FitNormals, OfAWaveAreSteeperThanTheMeanAboutAVertex) {
  // One period of a cosine over 4 cells. Means weighted by a point's distance to the vertex keep 8 / pi^2 =
  // 0.81 of the crests. The least-squares fit of linear pieces exceeds them, up to 0.81 / (2 / 3) = 1.22.
  const auto wave = [](float x, float) {
    return Eigen::Vector3f(0.2F * std::cos(6.2831853F * x), 0.0F, 1.0F);
  };
  Mesh coarse = square(4, 0.0F, upright);
  fit_normals(square(80, 0.0F, wave), 0.02F, 0.1F, coarse);
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v) {
    const float slope = coarse.normals[v].x() / coarse.normals[v].z();
    const float crest = wave(coarse.vertices[v].x(), 0.0F).x();
    EXPECT_NEAR(slope, 1.216F * crest, 0.02F) << coarse.vertices[v].transpose();
  }
}

TEST(FitNormals, OfAThinPlateDoNotMixItsSides) {
  const auto down = [](float, float) { return Eigen::Vector3f(0.1F, 0.0F, -1.0F); };
  const auto up = [](float, float) { return Eigen::Vector3f(0.0F, 0.1F, 1.0F); };
  const auto plate = [&](int n, bool is_lit) {
    Mesh mesh = square(n, 0.001F, up);
    Mesh under = square(n, 0.0F, down, false);
    if (!is_lit) {
      mesh.normals.assign(mesh.normals.size(), Eigen::Vector3f::UnitX());
      under.normals = mesh.normals;
    }
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (Triangle t : under.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    mesh.vertices.insert(mesh.vertices.end(), under.vertices.begin(), under.vertices.end());
    mesh.normals.insert(mesh.normals.end(), under.normals.begin(), under.normals.end());
    return mesh;
  };
  Mesh coarse = plate(2, false);
  fit_normals(plate(20, true), 0.01F, 0.1F, coarse);
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v) {
    const Eigen::Vector3f expected = coarse.vertices[v].z() > 0.0005F ? up(0, 0) : down(0, 0);
    EXPECT_LT(degrees_between(coarse.normals[v], expected), 4.0F) << v;
  }
}

TEST(FitNormals, WhatNoPointTellsOfStays) {
  const Eigen::Vector3f tilted = Eigen::Vector3f(0.3F, 0.0F, 1.0F).normalized();
  const Mesh before = square(2, 0.0F, [&](float, float) { return tilted; });
  Mesh fine = square(10, 0.5F, upright);  // out of reach
  Mesh coarse = before;
  fit_normals(fine, 0.02F, 0.1F, coarse);
  EXPECT_EQ(coarse.normals, before.normals);
  fine = square(10, 0.0F, [](float, float) { return Eigen::Vector3f(kNaN, 0.0F, 1.0F); });
  fit_normals(fine, 0.02F, 0.1F, coarse);
  EXPECT_EQ(coarse.normals, before.normals);
  fit_normals({}, 0.02F, 0.1F, coarse);
  EXPECT_EQ(coarse.normals, before.normals);

  // Only one half has points: normals in the other half stay.
  fine = square(10, 0.0F, upright);
  std::erase_if(fine.triangles, [&](const Triangle& t) { return fine.vertices[t[1]].x() > 0.45F; });
  fit_normals(fine, 0.02F, 0.1F, coarse);
  for (std::size_t v = 0; v < coarse.vertices.size(); ++v) {
    const float x = coarse.vertices[v].x();
    EXPECT_LT(degrees_between(coarse.normals[v], x > 0.9F ? tilted : Eigen::Vector3f::UnitZ()), 2.0F) << v;
    EXPECT_NEAR(coarse.normals[v].norm(), 1.0F, 1e-5F);
  }
}

}  // namespace
}  // namespace roomradar::fit_normals_test
