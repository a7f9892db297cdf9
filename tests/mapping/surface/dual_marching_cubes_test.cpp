// dual_marching_cubes_test.cpp: the mesh of any signed distances is a surface: no cracks, no edges of three
// triangles.
#include "mapping/surface/dual_marching_cubes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>

#include "mapping/surface/tsdf_extrapolation.hpp"
#include "mapping/surface/tsdf_smoothing.hpp"
#include "tests/support/edge_counts.hpp"

namespace roomradar::dual_marching_cubes_test {
namespace {

constexpr double kResolution_m = 0.01;
constexpr int kEdge = 20;  // voxels, over several bricks

// A cube of samples, starting at voxel (-kEdge / 2, ...).
template <typename Distance>
StaticMap cube_map(const Distance& distance_m, float weight = 1.0F) {
  StaticMap map(kResolution_m);
  for (int x = 0; x < kEdge; ++x)
    for (int y = 0; y < kEdge; ++y)
      for (int z = 0; z < kEdge; ++z) {
        const VoxelIndex voxel = VoxelIndex(x, y, z) - VoxelIndex::Constant(kEdge / 2);
        map.add_evidence(SurfaceSample{.voxel = voxel, .distance_m = distance_m(voxel), .weight = weight});
      }
  return map;
}

TsdfLevels levels_of(const StaticMap& map) {
  const Eigen::Vector3d reach_m = Eigen::Vector3d::Constant(map.reach_m());
  return {map, 0.0F, Eigen::AlignedBox3d(-reach_m, reach_m)};
}

// Returns the depth of a vertex inside the cube of samples, in voxels; the cube's outermost samples are at 0.
double depth_voxels(const Mesh& mesh, std::uint32_t vertex) {
  const Eigen::Array3d voxels =
      (mesh.origin + mesh.vertices[vertex].cast<double>()).array() / kResolution_m - 0.5 + kEdge / 2;
  return std::min(voxels.minCoeff(), (kEdge - 1 - voxels).minCoeff());
}

TEST(SurfaceNet, RandomSignsMakeASurfaceWhoseBorderIsWhereSamplesEnd) {
  std::mt19937 random(7);
  for (const double inside : {0.5, 0.3, 0.8}) {
    std::bernoulli_distribution is_inside(inside);
    std::uniform_real_distribution<float> size_m(0.001F, 0.009F);
    const StaticMap map =
        cube_map([&](const VoxelIndex&) { return is_inside(random) ? -size_m(random) : size_m(random); });
    const Mesh mesh = dual_marching_cubes(levels_of(map), kResolution_m);
    ASSERT_GT(mesh.triangles.size(), 5'000U);
    ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
    ASSERT_EQ(mesh.colours.size(), mesh.vertices.size());
    for (const auto& [edge, use] : test::edge_uses(mesh)) {
      ASSERT_LE(use.forward, 1);
      ASSERT_LE(use.backward, 1);
      if (use.forward == 1 && use.backward == 1) continue;
      ASSERT_LE(std::min(depth_voxels(mesh, edge.first), depth_voxels(mesh, edge.second)), 1.0);
    }
  }
}

TEST(SurfaceNet, APlaneIsWhereTheDistancesSay) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1.0, 2.0, -3.0).normalized();
  const StaticMap map = cube_map([&](const VoxelIndex& voxel) {
    return static_cast<float>(normal.dot(kResolution_m * (voxel.cast<double>().array() + 0.5).matrix()) -
                              0.0123);
  });
  for (const float strength : {0.0F, 50.0F}) {  // smoothing does not change linear distances
    TsdfLevels levels = levels_of(map);
    if (strength > 0.0F) smooth(levels, strength, 5);
    const Mesh mesh = dual_marching_cubes(levels, kResolution_m);
    ASSERT_GT(mesh.triangles.size(), 500U);
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      // Distances are stored in steps of 5 micrometres.
      ASSERT_NEAR(normal.dot(mesh.origin + mesh.vertices[v].cast<double>()), 0.0123, 2e-5);
      ASSERT_GT(normal.dot(mesh.normals[v].cast<double>()), 0.999);
    }
  }
}

TEST(SurfaceNet, SamplesOfOneSignOrNoneMakeNone) {
  EXPECT_TRUE(dual_marching_cubes(levels_of(StaticMap(kResolution_m)), kResolution_m).vertices.empty());
  const StaticMap map = cube_map([](const VoxelIndex&) { return 0.004F; });
  EXPECT_TRUE(dual_marching_cubes(levels_of(map), kResolution_m).triangles.empty());
}

TEST(SampleGuess, TheNetReachesTheOutermostMeasuredCrossings) {
  // A tilted plane, measured in 12 x 12 columns within one brick's reach of other bricks.
  constexpr int kFirst = -6, kLast = 5;
  const auto distance_m = [](const VoxelIndex& voxel) {
    return 0.01F * (static_cast<float>(voxel.z()) + 0.3F * static_cast<float>(voxel.x()) + 0.2F);
  };
  StaticMap map(0.01);
  for (int x = kFirst; x <= kLast; ++x)
    for (int y = kFirst; y <= kLast; ++y)
      for (int z = -4; z < 4; ++z)
        map.add_evidence(
            SurfaceSample{.voxel = {x, y, z}, .distance_m = distance_m({x, y, z}), .weight = 1.0F});
  TsdfLevels levels = levels_of(map);
  const auto reach = [&] {
    const Mesh mesh = dual_marching_cubes(levels, 0.01);
    Eigen::AlignedBox3f box;
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t) {
        box.extend(mesh.vertices[v]);
        const Eigen::Vector3d place = mesh.origin + mesh.vertices[v].cast<double>();
        // Voxel centres are half a voxel above their index.
        EXPECT_NEAR(place.z() - 0.005 + 0.3 * (place.x() - 0.005) + 0.002, 0.0, 1e-4);
        EXPECT_LT((mesh.normals[v] - Eigen::Vector3f(0.3F, 0.0F, 1.0F).normalized()).norm(), 0.02F);
      }
    return Eigen::Vector3f(box.sizes());
  };
  const Eigen::Vector3f before = reach();
  EXPECT_LT(before.y(), 0.105F);
  extrapolate_neighbours(levels);
  const Eigen::Vector3f after = reach();
  for (const float side_m : {after.x(), after.y()}) {
    EXPECT_GE(side_m, 0.01F * (kLast - kFirst));
    EXPECT_LE(side_m, 0.01F * (kLast - kFirst) + 0.003F);
  }
}

TEST(SampleGuess, RandomSignsWithGapsStillMakeASurface) {
  std::mt19937 random(9);
  std::bernoulli_distribution is_inside(0.4), is_missing(0.2);
  std::uniform_real_distribution<float> size_m(0.001F, 0.009F);
  TsdfLevels levels = levels_of(
      cube_map([&](const VoxelIndex&) { return is_inside(random) ? -size_m(random) : size_m(random); }));
  for (Brick& brick : levels.voxels.bricks())
    for (TsdfSample& sample : brick.samples)
      if (is_missing(random)) sample.weight = 0.0F;
  const std::size_t without_extrapolated = dual_marching_cubes(levels, kResolution_m).triangles.size();
  extrapolate_neighbours(levels);
  const Mesh mesh = dual_marching_cubes(levels, kResolution_m);
  EXPECT_GT(mesh.triangles.size(), 2 * without_extrapolated);
  for (const Eigen::Vector3f& vertex : mesh.vertices) ASSERT_TRUE(vertex.allFinite());
  for (const auto& [edge, use] : test::edge_uses(mesh)) {
    ASSERT_LE(use.forward, 1);
    ASSERT_LE(use.backward, 1);
  }
}

TEST(SampleSmoothing, WhatIsWellMeasuredStays) {
  const auto spread_m = [](float weight) {
    std::mt19937 random(3);
    std::normal_distribution<float> noise_m(0.0F, 0.004F);
    TsdfLevels levels = levels_of(cube_map([&](const VoxelIndex&) { return noise_m(random); }, weight));
    smooth(levels, 0.4F, 6);
    double sum = 0.0;
    for (const Brick& brick : levels.voxels.bricks())
      for (const TsdfSample& sample : brick.samples) sum += sample.distance_m * sample.distance_m;
    return std::sqrt(sum / (kEdge * kEdge * kEdge));
  };
  EXPECT_NEAR(spread_m(60.0F), 0.004, 1e-4);
  EXPECT_LT(spread_m(0.05F), 0.0015);
}

}  // namespace
}  // namespace roomradar::dual_marching_cubes_test
