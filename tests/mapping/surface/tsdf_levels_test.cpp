// tsdf_levels_test.cpp: samples in two grids, mirrored where the grids meet, and the surface over both.
#include "mapping/surface/tsdf_levels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "mapping/surface/dual_marching_cubes.hpp"
#include "mapping/surface/tsdf_extrapolation.hpp"
#include "mapping/surface/tsdf_smoothing.hpp"
#include "tests/support/edge_counts.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::tsdf_levels_test {
namespace {

constexpr Intrinsics kCamera{160, 120, 145.0, 145.0, 79.5, 59.5};
constexpr double kVoxel_m = 0.01;

Eigen::AlignedBox3d everywhere() { return {Eigen::Vector3d::Constant(-9.0), Eigen::Vector3d::Constant(9.0)}; }

/// A tilted wall, seen from 4 m, and its middle also from 1.2 m.
StaticMap wall_map(const Eigen::Vector3d& normal, double offset_m) {
  StaticMap map(kVoxel_m);
  for (const double x_m : {0.0, 0.0, 2.8}) {
    const Eigen::Isometry3d T_world_camera = test::looking_at({x_m, 0, 0}, {x_m + 1, 0, 0});
    const Frame frame = test::exact_frame(test::plane(normal, offset_m), kCamera, T_world_camera);
    EXPECT_EQ(map.fuse(frame, T_world_camera), FuseStatus::kFused);
  }
  return map;
}

struct Count {
  int own = 0, mirrored = 0;
};
Count known_in(const TsdfBricks& bricks) {
  Count count;
  for (const Brick& brick : bricks.bricks())
    for (const TsdfSample& sample : brick.samples)
      if (sample.known()) ++(sample.mirrored ? count.mirrored : count.own);
  return count;
}

TEST(TsdfLevels, EachSampleIsInOneGridAndMirroredSamplesLieOnTheSamePlane) {
  const StaticMap map = wall_map(Eigen::Vector3d::UnitX(), 4.003);
  const TsdfLevels levels(map, 0.0F, everywhere());
  int voxels = 0, coarse = 0;
  map.visit_cells(everywhere(), [&](const SurfaceSample&, int edge) { ++(edge == 1 ? voxels : coarse); });
  const Count in_voxels = known_in(levels.voxels), in_coarse = known_in(levels.coarse);
  EXPECT_EQ(in_voxels.own, voxels);
  EXPECT_EQ(in_coarse.own, coarse);
  EXPECT_GT(in_voxels.mirrored, 2'000);
  EXPECT_GT(in_coarse.mirrored, 500);
  // The distance along the viewing axis, at the centre of the cell. At the end of the truncation band, a
  // coarse cell has no neighbour along that axis to be interpolated with.
  for (const auto& [bricks, edge] : {std::pair{&levels.voxels, 1}, std::pair{&levels.coarse, kCoarseEdge}})
    for (const Brick& brick : bricks->bricks())
      for (int x = 0; x < kBrickEdge; ++x) {
        const double expected_m = 4.003 - edge * kVoxel_m * (brick.first.x() + x + 0.5);
        for (int y = 0; y < kBrickEdge; ++y) {
          const TsdfSample& sample = brick.samples[brick_offset({x, y, 3})];
          if (!sample.known()) continue;
          const double error_m = std::abs(sample.distance_m - expected_m);
          const bool is_near = std::abs(expected_m) < 0.03;
          ASSERT_LT(error_m, is_near || !sample.mirrored ? 1e-4 : 0.0051) << brick.first.transpose();
        }
      }
}

TEST(TsdfLevels, OfAMapWithoutCoarseCellsAreTheVoxelsAlone) {
  StaticMap map(kVoxel_m);
  map.add_evidence(SurfaceSample{.voxel = {3, 4, 5}, .distance_m = 0.002F, .weight = 1.0F});
  const TsdfLevels levels(map, 0.0F, everywhere());
  EXPECT_EQ(known_in(levels.voxels).own, 1);
  EXPECT_TRUE(levels.coarse.bricks().empty());
  EXPECT_TRUE(TsdfLevels(StaticMap(kVoxel_m), 0.0F, everywhere()).voxels.bricks().empty());
  EXPECT_TRUE(TsdfLevels(map, 0.0F, Eigen::AlignedBox3d()).voxels.bricks().empty());
}

// The wall's mesh has no crack, no step and no turned normal where the grids meet.
TEST(TsdfLevels, AWallOverBothGridsIsOneFlatMesh) {
  const Eigen::Vector3d normal = Eigen::Vector3d(1.0, 0.15, -0.1).normalized();
  for (const float strength : {0.0F, 0.4F}) {
    TsdfLevels levels(wall_map(normal, 3.9), 0.0F, everywhere());
    if (strength > 0.0F) smooth(levels, strength, 6);
    extrapolate_neighbours(levels);
    const Mesh mesh = dual_marching_cubes(levels, kVoxel_m);
    ASSERT_GT(mesh.triangles.size(), 40'000U);
    const auto is_inside = [&](std::uint32_t v) {
      const Eigen::Vector3d p = mesh.origin + mesh.vertices[v].cast<double>();
      return std::abs(p.y()) < 1.6 && std::abs(p.z()) < 1.1;
    };
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
      if (!is_inside(v)) continue;
      // The distances are measured along the viewing axis, through the pixel nearest to the cell's centre.
      ASSERT_NEAR(normal.dot(mesh.origin + mesh.vertices[v].cast<double>()), 3.9, 4e-3);
      ASSERT_LT(mesh.normals[v].cast<double>().dot(normal), -0.9);
    }
    for (const auto& [edge, use] : test::edge_uses(mesh)) {
      ASSERT_LE(use.forward, 1);
      ASSERT_LE(use.backward, 1);
      if (is_inside(edge.first)) {
        ASSERT_EQ(use.forward + use.backward, 2)
            << (mesh.origin + mesh.vertices[edge.first].cast<double>()).transpose();
      }
    }
  }
}

}  // namespace
}  // namespace roomradar::tsdf_levels_test
