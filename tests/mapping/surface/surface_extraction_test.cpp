// surface_extraction_test.cpp: position and orientation of the extracted surface, and parts it leaves out.
#include "mapping/surface/surface_extraction.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <random>

#include "mapping/mesh/components.hpp"
#include "mapping/surface/surface_parts.hpp"
#include "mapping/types/system/error.hpp"
#include "tests/support/edge_counts.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::surface_extraction_test {
namespace {

using test::exact_frame;
using test::looking_at;

constexpr Intrinsics kCamera{320, 240, 290.0, 290.0, 159.5, 119.5};
const Eigen::Isometry3d kAtOrigin = looking_at({0, 0, 0}, {1, 0, 0});

Eigen::Vector3d place(const Mesh& mesh, std::uint32_t vertex) {
  return mesh.origin + mesh.vertices[vertex].cast<double>();
}

void expect_consistent(const Mesh& mesh) {
  ASSERT_EQ(mesh.normals.size(), mesh.vertices.size());
  ASSERT_EQ(mesh.colours.size(), mesh.vertices.size());
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t vertex : triangle) ASSERT_LT(vertex, mesh.vertices.size());
}

// A ball seen from eight corners and six sides, without any background.
StaticMap ball_map(const Eigen::Vector3d& centre, double radius_m, double resolution_m) {
  StaticMap map(resolution_m);
  for (int i = 0; i < 27; ++i) {
    const Eigen::Vector3d side(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (side.isZero()) continue;
    const Eigen::Isometry3d T_world_camera =
        looking_at(centre + 3.0 * radius_m * side.normalized(), centre,
                   std::abs(side.z()) > 0.5 ? Eigen::Vector3d(1, 0.1, 0) : Eigen::Vector3d::UnitZ());
    EXPECT_EQ(map.fuse(exact_frame(test::sphere(centre, radius_m), kCamera, T_world_camera, Rgb{10, 200, 60}),
                       T_world_camera),
              FuseStatus::kFused);
  }
  return map;
}

TEST(Surface, AWallIsWhereItIsNotAtVoxelCentres) {
  StaticMap map(0.02);
  map.fuse(exact_frame(test::plane(Eigen::Vector3d::UnitX(), 1.507), kCamera, kAtOrigin), kAtOrigin);
  const Mesh mesh = extract_surface(map);
  ASSERT_FALSE(mesh.triangles.empty());
  expect_consistent(mesh);
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) ASSERT_NEAR(place(mesh, v).x(), 1.507, 1e-4);
  for (const Eigen::Vector3f& normal : mesh.normals)
    ASSERT_LT((normal + Eigen::Vector3f::UnitX()).norm(), 0.02F);
}

TEST(Surface, ABallIsRoundClosedAndLooksOutward) {
  const Eigen::Vector3d centre(0.3, -0.2, 0.1);
  const Mesh mesh = extract_surface(ball_map(centre, 0.3, 0.01), {.max_deviation_m = 0.0F});
  ASSERT_GT(mesh.triangles.size(), 5'000U);
  expect_consistent(mesh);
  double volume_m3 = 0.0;
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    const Eigen::Vector3d outward = place(mesh, v) - centre;
    // On surfaces seen at a slant, the distance along the viewing axis exceeds the distance to the surface,
    // here by up to 3 mm.
    ASSERT_NEAR(outward.norm(), 0.3, 0.004);
    ASSERT_GT(outward.normalized().dot(mesh.normals[v].cast<double>()), 0.85);
    ASSERT_EQ(mesh.colours[v], (Rgb{10, 200, 60}));
  }
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = place(mesh, t[0]) - centre, b = place(mesh, t[1]) - centre,
                          c = place(mesh, t[2]) - centre;
    volume_m3 += a.dot(b.cross(c)) / 6.0;
    for (int k = 0; k < 3; ++k)
      ++edges[{t[static_cast<std::size_t>(k)], t[static_cast<std::size_t>((k + 1) % 3)]}];
  }
  // Positive: counter-clockwise seen from outside.
  EXPECT_NEAR(volume_m3, 4.0 / 3.0 * M_PI * 0.027, 0.01 * 0.113);
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_EQ(edges.count({edge.second, edge.first}), 1U) << "the ball has a hole";
  }
}

TEST(Surface, AWallIsAFewTrianglesAndABallStaysRound) {
  StaticMap map(0.02);
  map.fuse(exact_frame(test::plane(Eigen::Vector3d(0.8, 0.6, 0), 1.5), kCamera, kAtOrigin), kAtOrigin);
  SurfaceStats facts;
  const Mesh wall = extract_surface(map, {}, &facts);
  EXPECT_EQ(facts.triangles, wall.triangles.size());
  EXPECT_GT(facts.full_triangles, 5'000U);
  EXPECT_LT(wall.triangles.size() * 20, facts.full_triangles);
  EXPECT_LE(facts.deviation_m, 0.003F);
  const Mesh ball = extract_surface(ball_map({0, 0, 0}, 0.3, 0.01));
  for (const Triangle& t : ball.triangles) {
    const Eigen::Vector3d middle = (place(ball, t[0]) + place(ball, t[1]) + place(ball, t[2])) / 3.0;
    ASSERT_NEAR(middle.norm(), 0.3, 0.004 + 0.003);  // the ball's own error, and the bound
  }
}

TEST(Surface, NoiseOfAFarWallIsAveragedAndThatOfANearOneIsNot) {
  // Samples around the plane z = 0; all samples of a column have the same error.
  const auto roughness_m = [](float weight) {
    std::mt19937 random(11);
    std::normal_distribution<float> noise_m(0.0F, 0.005F);
    StaticMap map(0.01);
    for (int x = 0; x < 40; ++x)
      for (int y = 0; y < 40; ++y) {
        const float off_m = noise_m(random);
        for (int z = -4; z < 4; ++z)
          map.add_evidence(SurfaceSample{.voxel = {x, y, z},
                                         .distance_m = 0.01F * (static_cast<float>(z) + 0.5F) + off_m,
                                         .weight = weight});
      }
    const Mesh mesh = extract_surface(map, {.min_component_area_m2 = 0.0F, .max_deviation_m = 0.0F});
    double sum = 0.0;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) sum += std::abs(place(mesh, v).z());
    return sum / static_cast<double>(mesh.vertices.size());
  };
  EXPECT_GT(roughness_m(20.0F), 0.0015);
  EXPECT_LT(roughness_m(0.05F), 0.001);
}

TEST(Surface, ItsBorderDoesNotDependOnWhereBricksBegin) {
  const auto triangles = [](const VoxelIndex& shift) {
    StaticMap map(0.01);
    for (int x = 0; x < 13; ++x)
      for (int y = 0; y < 13; ++y)
        for (int z = -3; z < 3; ++z)
          map.add_evidence(SurfaceSample{.voxel = shift + VoxelIndex(x, y, z),
                                         .distance_m = 0.01F * (static_cast<float>(z) + 0.5F),
                                         .weight = 20.0F});
    return extract_surface(map, {.min_component_area_m2 = 0.0F, .max_deviation_m = 0.0F}).triangles.size();
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int shift = 0; shift < 8; ++shift)
      // Two for each of the 13 x 13 measured crossings.
      EXPECT_EQ(triangles(shift * VoxelIndex::Unit(axis)), 338U) << "axis " << axis << ", shift " << shift;
}

TEST(SurfaceParts, JoinedAreTheWholeSurface) {
  const StaticMap map = ball_map({0.3, -0.2, 0.1}, 0.3, 0.01);
  const Eigen::Vector3d reach = Eigen::Vector3d::Constant(map.reach_m());
  const Mesh whole = extract_full_surface(map, {-reach, reach});
  const std::vector<Eigen::AlignedBox3d> boxes = divide(map, 300);
  ASSERT_GT(boxes.size(), 4U);
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kSurfaceReach_voxels * map.resolution_m());
  const Mesh joined = join_parts(boxes, [&](const Eigen::AlignedBox3d& box) {
    return part_in(box, extract_full_surface(map, {box.min() - margin, box.max() + margin}));
  });
  EXPECT_EQ(joined.vertices.size(), whole.vertices.size()) << "vertices on seams are merged";
  expect_consistent(joined);
  const auto triangles_of = [](const Mesh& mesh) {
    std::vector<std::array<double, 9>> triangles;
    for (const Triangle& t : mesh.triangles) {
      std::array<double, 9> corners{};
      for (std::size_t i = 0; i < 9; ++i)
        corners[i] = place(mesh, t[i / 3])[static_cast<Eigen::Index>(i % 3)];
      triangles.push_back(corners);
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  EXPECT_EQ(triangles_of(joined), triangles_of(whole));
}

TEST(SurfaceParts, SimplifiedTheyFitWithoutCracks) {
  const Eigen::Vector3d centre(0.3, -0.2, 0.1);
  const StaticMap map = ball_map(centre, 0.3, 0.01);
  const std::vector<Eigen::AlignedBox3d> boxes = divide(map, 300);
  ASSERT_GT(boxes.size(), 4U);
  std::size_t full_triangles = 0;
  const Mesh joined = join_parts(boxes, [&](const Eigen::AlignedBox3d& box) {
    SurfaceStats stats;
    SurfacePart part = extract_surface_part(map, box, {}, &stats);
    EXPECT_LE(stats.deviation_m, SurfaceConfig{}.max_deviation_m);
    full_triangles += stats.full_triangles;
    return part;
  });
  SurfaceStats whole;
  extract_surface(map, {}, &whole);
  EXPECT_EQ(full_triangles, whole.full_triangles);
  EXPECT_LT(joined.triangles.size(), full_triangles / 2);
  expect_consistent(joined);
  for (const auto& [edge, use] : test::edge_uses(joined)) {
    ASSERT_EQ(use.forward, 1) << "the ball has a crack";
    ASSERT_EQ(use.backward, 1) << "the ball has a crack";
  }
}

TEST(Surface, SpecksGoAndSurfacesStay) {
  StaticMap map(0.01);
  const test::Scene scene =
      test::nearest_of(test::sphere({1.0, 0.3, 0.2}, 0.03), test::plane(Eigen::Vector3d::UnitX(), 1.5));
  map.fuse(exact_frame(scene, kCamera, kAtOrigin), kAtOrigin);
  const auto nearest_m = [](const Mesh& mesh) {
    double nearest = 10.0;
    for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) nearest = std::min(nearest, place(mesh, v).x());
    return nearest;
  };
  EXPECT_LT(nearest_m(extract_surface(map, {.min_component_area_m2 = 0.0F})), 1.05);
  const Mesh kept = extract_surface(map);
  EXPECT_GT(nearest_m(kept), 1.45);
  EXPECT_GT(kept.triangles.size(), 10U);
}

TEST(Surface, WhatNobodySawStaysOpen) {
  Frame frame = exact_frame(test::plane(Eigen::Vector3d::UnitX(), 1.5), kCamera, kAtOrigin);
  for (int y = 90; y < 150; ++y)
    for (int x = 130; x < 190; ++x) frame.depth_m.at(x, y) = 0.0F;
  StaticMap map(0.01);
  map.fuse(frame, kAtOrigin);
  const Mesh mesh = extract_surface(map);
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d middle = (place(mesh, t[0]) + place(mesh, t[1]) + place(mesh, t[2])) / 3.0;
    ASSERT_GT(std::max(std::abs(middle.y()), std::abs(middle.z())), 0.12);
  }
}

TEST(Surface, AnEmptyMapHasNone) {
  EXPECT_TRUE(extract_surface(StaticMap(0.05)).triangles.empty());
  EXPECT_TRUE(extract_surface(StaticMap(0.05)).vertices.empty());
  EXPECT_TRUE(drop_small_components(Mesh{}, 1.0F).triangles.empty());
}

TEST(Surface, ThreeHundredMetresAwayItIsTheSame) {
  const Mesh near = extract_surface(ball_map({0, 0, 0}, 0.2, 0.01));
  const Mesh far = extract_surface(ball_map({300, 300, -300}, 0.2, 0.01));
  EXPECT_NEAR(static_cast<double>(far.vertices.size()), static_cast<double>(near.vertices.size()),
              0.1 * static_cast<double>(near.vertices.size()));
  for (std::uint32_t v = 0; v < far.vertices.size(); ++v)
    ASSERT_NEAR((place(far, v) - Eigen::Vector3d(300, 300, -300)).norm(), 0.2, 0.004);
}

TEST(Surface, ConfigOutsideItsRulesIsNamed) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const SurfaceConfig& bad :
       {SurfaceConfig{.min_weight = nan}, SurfaceConfig{.smoothing = -1.0F},
        SurfaceConfig{.min_component_area_m2 = -1.0F}, SurfaceConfig{.max_deviation_m = -0.1F}})
    EXPECT_THROW(static_cast<void>(extract_surface(StaticMap(0.05), bad)), Error);
}

}  // namespace
}  // namespace roomradar::surface_extraction_test
