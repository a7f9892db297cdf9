// cell_levels_test.cpp: coarse cells where a surface was measured from afar only, and their refinement.
#include "mapping/octree/cell_levels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/surface/surface_extraction.hpp"
#include "mapping/types/depth_noise.hpp"
#include "tests/support/edge_counts.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/map_content.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::cell_levels_test {
namespace {

using test::error_of;
using test::exact_frame;
using test::expect_equal;
using test::looking_at;
using test::samples_of;

constexpr Intrinsics kCamera{160, 120, 145.0, 145.0, 79.5, 59.5};
constexpr double kVoxel_m = 0.01;
constexpr double kWall_m = 4.003;

FusionConfig voxels_only() {
  FusionConfig config;
  config.max_cell_sigmas = 0.0F;
  return config;
}

// A camera at x_m that looks along +x at a wall at kWall_m.
Eigen::Isometry3d camera_at(double x_m) { return looking_at({x_m, 0, 0}, {x_m + 1, 0, 0}); }
Frame wall_from(double x_m) {
  return exact_frame(test::plane(Eigen::Vector3d::UnitX(), kWall_m), kCamera, camera_at(x_m),
                     Rgb{200, 100, 50});
}
void fuse(StaticMap& map, double x_m) {
  ASSERT_EQ(map.fuse(wall_from(x_m), camera_at(x_m)), FuseStatus::kFused);
}

double error_m(const SurfaceSample& sample) {
  return std::abs(static_cast<double>(sample.distance_m) - (kWall_m - (sample.voxel.x() + 0.5) * kVoxel_m));
}

// Away from the border of the image, where a cell may lack neighbours.
bool is_inside(const SurfaceSample& sample) {
  return std::abs(sample.voxel.y()) < 150 && std::abs(sample.voxel.z()) < 100;
}

TEST(CellLevels, CellsAreCoarseFromTheDepthWhoseNoiseFitsThem) {
  const FusionConfig config;
  const float from_m = coarse_from_m(0.01, config);
  EXPECT_NEAR(depth_sigma_m(DepthNoise{}, from_m) * config.max_cell_sigmas, 0.02F, 1e-6F);
  EXPECT_GT(from_m, 2.0F);
  EXPECT_LT(from_m, 2.5F);
  EXPECT_GT(coarse_from_m(0.02, config), from_m + 0.5F);
  constexpr float kNever_m = std::numeric_limits<float>::infinity();
  EXPECT_EQ(coarse_from_m(0.1, config), kNever_m) << "no depth within range is that noisy";
  EXPECT_EQ(coarse_from_m(0.01, voxels_only()), kNever_m);
  EXPECT_NEAR(depth_of_sigma_m(DepthNoise{}, 0.0F), 0.4F, 1e-6F);
  FusionConfig bad;
  for (const float value : {-1.0F, std::nanf(""), 1e9F}) {
    bad.max_cell_sigmas = value;
    EXPECT_NE(error_of([&] { StaticMap map(0.01, bad); }).find("max_cell_sigmas"), std::string::npos);
  }
}

// A plane's distances in a leaf block whose lowest cell is at `low`, in edges of a coarse cell.
LeafBlock plane_block(const Eigen::Vector3d& low, const Eigen::Vector3d& slope) {
  LeafBlock block;
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d cell = low + Eigen::Vector3d(i & 1U, i >> 1U & 1U, i >> 2U & 1U);
    block.distance[i] = static_cast<std::int16_t>(std::lround(100.0 + slope.dot(cell)));
    block.weight[i] = 7;
  }
  return block;
}

TEST(CellLevels, VoxelsOfACoarseCellLieOnThePlaneThatItsBlockMeasures) {
  BlockOctree tree(kVoxel_m, {});
  const Eigen::Vector3d slope(400.0, -300.0, 120.0);  // per edge of a coarse cell
  Sides all, none;
  for (unsigned k = 0; k < 6; ++k) {
    const Eigen::Vector3d low = (k % 2 == 0 ? -2.0 : 2.0) * Eigen::Vector3d::Unit(k / 2);
    all[k] = OctreeWriter(tree).prune(Slot(), plane_block(low, slope));
  }
  const LeafBlock block = plane_block(Eigen::Vector3d::Zero(), slope);
  for (const Sides& sides : {all, none})
    for (unsigned i = 0; i < 8; ++i)
      for (unsigned j = 0; j < 8; ++j) {
        const Eigen::Vector3d cell(i & 1U, i >> 1U & 1U, i >> 2U & 1U);
        const Eigen::Vector3d voxel(j & 1U, j >> 1U & 1U, j >> 2U & 1U);
        const double expected = 100.0 + slope.dot(cell + 0.5 * voxel - Eigen::Vector3d::Constant(0.25));
        EXPECT_NEAR(voxel_distances(tree, block, sides, i)[j], expected, 0.5) << i << " " << j;
      }
  // The neighbours' values count, not only their presence.
  tree.leaves(all[1]).distance.fill(0);
  EXPECT_EQ(voxel_distances(tree, block, all, 1)[1], std::lround(0.75 * 500 + 75 - 30));
  // A cell without neighbours has one distance; extreme distances do not overflow.
  LeafBlock alone;
  alone.distance[3] = -500;
  alone.weight[3] = 1;
  for (const std::int16_t distance : voxel_distances(tree, alone, none, 3)) EXPECT_EQ(distance, -500);
  LeafBlock extreme;
  extreme.weight.fill(1);
  extreme.distance = {-32767, 32767, -32767, 32767, -32767, 32767, -32767, 32767};
  EXPECT_EQ(voxel_distances(tree, extreme, none, 1)[1], 32767);
  EXPECT_EQ(voxel_distances(tree, extreme, none, 0)[0], -32767);
}

TEST(CellLevels, AFarWallTakesAFractionOfTheMemoryAndStaysWhereItIs) {
  StaticMap coarse(kVoxel_m), fine(kVoxel_m, voxels_only());
  for (int i = 0; i < 3; ++i) {
    fuse(coarse, 0.0);
    fuse(fine, 0.0);
  }
  EXPECT_LT(4 * coarse.counts().memory_bytes, fine.counts().memory_bytes);
  const std::vector<SurfaceSample> samples = samples_of(coarse);
  EXPECT_GT(samples.size(), 100'000U);
  for (const SurfaceSample& sample : samples)
    if (is_inside(sample)) {
      ASSERT_LT(error_m(sample), 1e-4);
    }
  const Eigen::Vector3d on_wall(kWall_m, 0.3, -0.2);
  ASSERT_TRUE(coarse.sample_at(on_wall));
  EXPECT_LT(error_m(*coarse.sample_at(on_wall)), 1e-4);
  EXPECT_EQ(coarse.sample_at(on_wall)->colour, (Rgb{200, 100, 50}));
  EXPECT_EQ(coarse.occupancy_at({kWall_m - 0.2, 0.3, -0.2}), Occupancy::kFree);
  EXPECT_EQ(coarse.occupancy_at({kWall_m + 0.2, 0.3, -0.2}), Occupancy::kUnknown);
}

TEST(CellLevels, CloseFramesRefineAndFarFramesNeverCoarsen) {
  StaticMap map(kVoxel_m);
  const auto in_middle = [&] {
    std::size_t count = 0;
    const Eigen::AlignedBox3d box(Eigen::Vector3d(3, -0.2, -0.2), Eigen::Vector3d(5, 0.2, 0.2));
    map.visit_samples(box, [&](const SurfaceSample&) { ++count; });
    return count;
  };
  fuse(map, 0.0);
  const std::size_t bytes = map.counts().memory_bytes, wide_band = in_middle();
  fuse(map, 2.9);  // from 1.1 m
  EXPECT_GT(map.counts().memory_bytes, bytes + bytes / 10);
  EXPECT_LT(in_middle(), wide_band) << "refined samples outside the voxels' truncation band are dropped";
  for (int i = 0; i < 5; ++i) fuse(map, 0.0);
  EXPECT_GT(map.counts().memory_bytes, bytes);
  for (const SurfaceSample& sample : samples_of(map))
    if (is_inside(sample)) {
      ASSERT_LT(error_m(sample), 1e-4);
    }

  // Where the close frame looked, the map is what fine cells alone would have made of it.
  StaticMap fine(kVoxel_m, voxels_only());
  fuse(fine, 0.0);
  fuse(fine, 2.9);
  for (int i = 0; i < 5; ++i) fuse(fine, 0.0);
  for (double y_m = -0.3; y_m < 0.3; y_m += 0.013) {
    const Eigen::Vector3d p(kWall_m, y_m, 0.1);
    EXPECT_EQ(map.occupancy_at(p), fine.occupancy_at(p));
    ASSERT_TRUE(map.sample_at(p) && fine.sample_at(p));
    EXPECT_NEAR(map.sample_at(p)->distance_m, fine.sample_at(p)->distance_m, 1e-5);
    EXPECT_NEAR(map.sample_at(p)->weight, fine.sample_at(p)->weight, 0.02F * fine.sample_at(p)->weight);
  }
}

TEST(CellLevels, TheSurfaceHasNoStepOrCrackWhereFineAndCoarseCellsMeet) {
  StaticMap map(kVoxel_m);
  std::mt19937 random(5);
  for (int i = 0; i < 42; ++i) {
    const double x_m = i < 40 ? 0.005 * i : 2.9;
    Frame frame = wall_from(x_m);
    for (float& depth_m : frame.depth_m.pixels)
      depth_m += std::normal_distribution<float>(0.0F, 0.2F * depth_sigma_m(DepthNoise{}, depth_m))(random);
    ASSERT_EQ(map.fuse(frame, camera_at(x_m)), FuseStatus::kFused);
  }
  SurfaceConfig config;
  config.max_deviation_m = 0.0F;
  const Mesh mesh = extract_surface(map, config);
  ASSERT_GT(mesh.triangles.size(), 60'000U) << "the wall is 4 x 3 m";
  ASSERT_LT(mesh.triangles.size(), 120'000U) << "most of it is of coarse cells";
  double greatest_m = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d p = mesh.origin + vertex.cast<double>();
    if (std::abs(p.y()) < 1.5 && std::abs(p.z()) < 1.0)
      greatest_m = std::max(greatest_m, std::abs(p.x() - kWall_m));
  }
  EXPECT_LT(greatest_m, 0.008) << "0.2 sigma of noise at 4 m is 5 mm a pixel";
  // Inside of the wall, every edge belongs to two triangles.
  for (const auto& [edge, use] : test::edge_uses(mesh)) {
    const Eigen::Vector3d p = mesh.origin + mesh.vertices[edge.first].cast<double>();
    if (std::abs(p.y()) > 1.5 || std::abs(p.z()) > 1.0) continue;
    ASSERT_EQ(use.forward, 1) << p.transpose();
    ASSERT_EQ(use.backward, 1) << p.transpose();
  }
}

TEST(CellLevels, AFloorSeenObliquelyKeepsNoHoleWhereItIsRefined) {
  // A camera 1.2 m above the floor sees it at grazing angles of 15 to 30 degrees, first from afar, then from
  // nearer and from one side.
  StaticMap map(kVoxel_m);
  const auto look = [&](double x_m, double y_m) {
    const Eigen::Isometry3d T_world_camera = looking_at({x_m, y_m, 1.2}, {x_m + 3.0, y_m, 0.0});
    const Frame frame =
        exact_frame(test::plane(Eigen::Vector3d::UnitZ(), 0.003), kCamera, T_world_camera, Rgb{90, 90, 90});
    ASSERT_EQ(map.fuse(frame, T_world_camera), FuseStatus::kFused);
  };
  for (int i = 0; i < 40; ++i) look(0.004 * i, 0.0);
  for (int i = 0; i < 3; ++i) look(1.2 + 0.004 * i, 0.4);
  SurfaceConfig config;
  config.max_deviation_m = 0.0F;
  const Mesh mesh = extract_surface(map, config);
  std::size_t open_edges = 0, edges = 0;
  for (const auto& [edge, use] : test::edge_uses(mesh)) {
    const Eigen::Vector3d p = mesh.origin + mesh.vertices[edge.first].cast<double>();
    if (p.x() < 2.2 || p.x() > 3.6 || std::abs(p.y()) > 0.6) continue;
    ++edges;
    open_edges += use.forward + use.backward == 1 ? 1 : 0;
  }
  EXPECT_GT(edges, 30'000U);
  EXPECT_EQ(open_edges, 0U);
}

TEST(CellLevels, AMapOfBothSizesIsTheSameAfterAFile) {
  const test::TemporaryFolder folder;
  StaticMap map(kVoxel_m);
  fuse(map, 0.0);
  fuse(map, 2.9);
  map.write_ot(folder.path() / "a.ot");
  const StaticMap read = StaticMap::read_ot(folder.path() / "a.ot");
  read.write_ot(folder.path() / "b.ot");
  const auto bytes = [&](const char* name) {
    std::ifstream file(folder.path() / name, std::ios::binary);
    std::ostringstream all;
    all << file.rdbuf();
    return all.str();
  };
  EXPECT_EQ(bytes("a.ot"), bytes("b.ot"));
  EXPECT_EQ(read.counts().memory_bytes, map.counts().memory_bytes) << "coarse cells stay coarse";
  expect_equal(map, read);
  // The next frame changes both alike.
  StaticMap copy = StaticMap::read_ot(folder.path() / "a.ot");
  fuse(map, 0.1);
  fuse(copy, 0.1);
  EXPECT_EQ(map.counts().memory_bytes, copy.counts().memory_bytes);
}

TEST(CellLevels, RevisingOneVoxelOfACoarseCellLeavesTheOthers) {
  StaticMap map(kVoxel_m);
  fuse(map, 0.0);
  const std::vector<SurfaceSample> before = samples_of(map);
  std::size_t visited = 0;
  map.revise_samples([&](const SurfaceSample&) {
    ++visited;
    return SampleAction::kKeep;
  });
  EXPECT_GE(visited, before.size());
  EXPECT_EQ(samples_of(map).size(), before.size()) << "keeping everything refines nothing";

  const Eigen::Vector3d p(kWall_m, 0.203, 0.104);
  const VoxelIndex voxel = map.sample_at(p)->voxel;
  const Occupancy occupancy = map.occupancy_at(p);  // of the whole cell
  map.revise_samples([&](const SurfaceSample& sample) {
    return sample.voxel == voxel ? SampleAction::kFree : SampleAction::kKeep;
  });
  EXPECT_FALSE(map.sample_at(p));
  EXPECT_EQ(map.occupancy_at(p), Occupancy::kFree);
  for (int axis = 1; axis < 3; ++axis) {
    Eigen::Vector3d beside = (voxel.cast<double>().array() + 0.5) * kVoxel_m;
    beside[axis] += (voxel[axis] & 1) != 0 ? -kVoxel_m : kVoxel_m;  // in the same cell
    ASSERT_TRUE(map.sample_at(beside));
    EXPECT_LT(error_m(*map.sample_at(beside)), 1e-4);
    EXPECT_EQ(map.occupancy_at(beside), occupancy);
  }
}

TEST(CellLevels, EvidenceForOneVoxelRefinesItsCell) {
  StaticMap map(kVoxel_m);
  fuse(map, 0.0);
  const Eigen::Vector3d p(kWall_m, 0.203, 0.104);
  const VoxelIndex voxel = map.sample_at(p)->voxel;
  map.add_evidence(SurfaceSample{.voxel = voxel, .distance_m = 0.02F, .weight = 1e6F});
  EXPECT_NEAR(map.sample_at(p)->distance_m, 0.02F, 1e-4F);
  const Eigen::Vector3d beside((voxel.x() + 0.5) * kVoxel_m, ((voxel.y() ^ 1) + 0.5) * kVoxel_m,
                               (voxel.z() + 0.5) * kVoxel_m);
  EXPECT_LT(error_m(*map.sample_at(beside)), 1e-4);
  const Occupancy occupancy = map.occupancy_at(beside);
  for (int i = 0; i < 20; ++i) map.add_evidence(MapLeaf{voxel, 1, -1.0F});
  EXPECT_EQ(map.occupancy_at(p), Occupancy::kFree);
  EXPECT_EQ(map.occupancy_at(beside), occupancy);
}

TEST(CellLevels, WhatIsSeenThroughGoesFromCoarseCellsToo) {
  StaticMap map(kVoxel_m);
  const auto scene = [](bool with_box) {
    const test::Scene wall = test::plane(Eigen::Vector3d::UnitX(), 4.6);
    return with_box ? test::nearest_of(
                          wall, test::box({Eigen::Vector3d(3.4, -0.3, -0.3), Eigen::Vector3d(3.8, 0.3, 0.3)}))
                    : wall;
  };
  const auto look = [&](bool with_box, int times) {
    for (int i = 0; i < times; ++i)
      (void)map.fuse(exact_frame(scene(with_box), kCamera, camera_at(0.0)), camera_at(0.0));
  };
  look(false, 10);
  const std::size_t nodes = map.counts().nodes;
  look(true, 3);
  EXPECT_EQ(map.occupancy_at({3.41, 0, 0}), Occupancy::kOccupied);
  look(false, 60);
  EXPECT_EQ(map.occupancy_at({3.41, 0, 0}), Occupancy::kFree);
  EXPECT_FALSE(map.sample_at({3.41, 0, 0}));
  EXPECT_LT(map.counts().nodes, nodes + nodes / 20);
}

}  // namespace
}  // namespace roomradar::cell_levels_test
