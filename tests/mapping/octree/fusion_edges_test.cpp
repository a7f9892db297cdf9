// fusion_edges_test.cpp: numerical limits of fusion: ranges, integer averages, pools, float against double.
#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cmath>
#include <future>
#include <memory>
#include <random>
#include <vector>

#include "mapping/octree/block_octree.hpp"
#include "mapping/octree/fusion.hpp"
#include "mapping/octree/octomap_tree.hpp"
#include "mapping/octree/prepared_frame.hpp"
#include "mapping/octree/static_map.hpp"
#include "mapping/types/depth_noise.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::fusion_edges_test {
namespace {

using test::exact_frame;
using test::looking_at;

constexpr Intrinsics kCamera{160, 120, 145.0, 145.0, 79.5, 59.5};
const Eigen::Isometry3d kAtOrigin = looking_at({0, 0, 0}, {1, 0, 0});  // along +x

Frame wall_at(double x_m, Rgb colour = {200, 100, 50}) {
  return exact_frame(test::plane(Eigen::Vector3d::UnitX(), x_m), kCamera, kAtOrigin, colour);
}

TEST(FusionEdges, AFrameOfConstantDepthIsAWallAcrossTheAxis) {
  Frame frame = wall_at(1.0);
  for (float& depth_m : frame.depth_m.pixels) depth_m = 2.01F;
  StaticMap map(0.02);
  ASSERT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kFused);
  int occupied = 0;
  map.visit_leaves([&](const MapLeaf& leaf) {
    if (leaf.log_odds < 0.0F) return;
    ASSERT_EQ(leaf.lowest_voxel.x(), 100);  // 2.00..2.02 m
    ++occupied;
  });
  EXPECT_GT(occupied, 5'000);  // 2.2 x 1.7 m of wall
  map.visit_samples([&](const SurfaceSample& sample) {
    ASSERT_NEAR(sample.distance_m, 2.01 - (sample.voxel.x() + 0.5) * 0.02, 2e-5);
  });
}

TEST(FusionEdges, DepthAtTheNearAndFarEndOfTheSensor) {
  StaticMap near(0.01);
  ASSERT_EQ(near.fuse(wall_at(0.405), kAtOrigin), FuseStatus::kFused);
  EXPECT_EQ(near.occupancy_at({0.405, 0.003, 0.003}), Occupancy::kOccupied);
  EXPECT_EQ(near.occupancy_at({0.2, 0, 0}), Occupancy::kFree);

  StaticMap far(0.05);  // beyond max_range_m: nothing is occupied; space up to max_range_m is free
  ASSERT_EQ(far.fuse(wall_at(8.0), kAtOrigin), FuseStatus::kFused);
  EXPECT_EQ(far.counts().occupied_leaves, 0U);
  EXPECT_EQ(far.counts().sampled_leaves, 0U);
  EXPECT_EQ(far.occupancy_at({4.9, 0, 0}), Occupancy::kFree);
  EXPECT_EQ(far.occupancy_at({5.2, 0, 0}), Occupancy::kUnknown);

  StaticMap reaching(0.05, {.max_range_m = 9.0F});
  ASSERT_EQ(reaching.fuse(wall_at(8.02), kAtOrigin), FuseStatus::kFused);
  EXPECT_EQ(reaching.occupancy_at({8.02, 0.02, 0.02}), Occupancy::kOccupied);
  const auto sample = reaching.sample_at({8.02, 0.02, 0.02});
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->distance_m, 8.02 - 8.025, 1e-4);
  // Its weight is 4e-4, less than one step of the stored weights, but it still counts.
  EXPECT_GT(sample->weight, 0.0F);
}

TEST(FusionEdges, LogOddsAndWeightsOfTenThousandFramesAreWithinTheirBounds) {
  constexpr Intrinsics kSmall{16, 12, 15.0, 15.0, 7.5, 5.5};
  const Frame frame = exact_frame(test::plane(Eigen::Vector3d::UnitX(), 1.503), kSmall, kAtOrigin);
  StaticMap map(0.05);
  for (int i = 0; i < 10'000; ++i) ASSERT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kFused);
  bool at_least = false, at_most = false;
  map.visit_leaves([&](const MapLeaf& leaf) {
    ASSERT_GE(leaf.log_odds, map.config().min_log_odds - 1e-3F);
    ASSERT_LE(leaf.log_odds, map.config().max_log_odds + 1e-3F);
    at_least |= leaf.log_odds < map.config().min_log_odds + 1e-3F;
    at_most |= leaf.log_odds > map.config().max_log_odds - 1e-3F;
  });
  EXPECT_TRUE(at_least && at_most);
  map.visit_samples(
      [&](const SurfaceSample& sample) { ASSERT_NEAR(sample.weight, map.config().max_weight, 1e-3); });
}

TEST(FusionEdges, AveragesInWholeStepsStayWithinATenthOfAMillimetreOfTrueOnes) {
  StaticMap map(0.02);
  std::mt19937 random(4);
  std::normal_distribution<double> noise_m(0.0, 0.006);  // the Kinect's noise at 2 m
  double sum = 0.0, weights = 0.0;
  const Eigen::Vector3d p(2.01, 0.01, 0.01);  // a voxel's centre
  for (int i = 0; i < 500; ++i) {
    const double x_m = 2.013 + noise_m(random);
    ASSERT_EQ(map.fuse(wall_at(x_m), kAtOrigin), FuseStatus::kFused);
    const double sigma_m = depth_sigma_m(DepthNoise{}, static_cast<float>(x_m)),
                 at_1m = depth_sigma_m(DepthNoise{}, 1.0F);
    const double weight = at_1m * at_1m / (sigma_m * sigma_m);
    sum += weight * (x_m - p.x());
    weights += weight;
  }
  const auto sample = map.sample_at(p);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->distance_m, sum / weights, 1e-4);
  EXPECT_NEAR(sample->weight, weights, 0.01 * weights);
}

TEST(FusionEdges, ANoisierSensorWeighsLessInTheSameMap) {
  StaticMap map(0.02);
  const DepthNoise phone{0.003F, 0.008F, 0.0F, 0.0F, 0.0F};
  const double near_m = 2.003, far_m = 2.023;
  Frame by_phone = wall_at(far_m);
  by_phone.depth_noise = phone;
  ASSERT_EQ(map.fuse(wall_at(near_m), kAtOrigin), FuseStatus::kFused);
  ASSERT_EQ(map.fuse(by_phone, kAtOrigin), FuseStatus::kFused);
  const auto sigma_m = [](const DepthNoise& noise, double depth_m) {
    return static_cast<double>(depth_sigma_m(noise, static_cast<float>(depth_m)));
  };
  const double unit = std::pow(sigma_m({}, 1.0), 2);
  const double kinect_weight = unit / std::pow(sigma_m({}, near_m), 2),
               phone_weight = unit / std::pow(sigma_m(phone, far_m), 2);
  ASSERT_LT(phone_weight, 0.3 * kinect_weight);
  const Eigen::Vector3d p(2.01, 0.01, 0.01);  // a voxel's centre
  const auto sample = map.sample_at(p);
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->weight, kinect_weight + phone_weight, 0.01 * kinect_weight);
  EXPECT_NEAR(p.x() + sample->distance_m,
              (kinect_weight * near_m + phone_weight * far_m) / (kinect_weight + phone_weight), 2e-4);
}

TEST(FusionEdges, AMillimetreAndAMetreBothHoldTheWall) {
  for (const double resolution_m : {0.001, 1.0}) {
    constexpr Intrinsics kSmall{32, 24, 30.0, 30.0, 15.5, 11.5};
    const double x_m = resolution_m < 0.01 ? 0.5003 : 3.5;
    StaticMap map(resolution_m);
    const Frame frame = exact_frame(test::plane(Eigen::Vector3d::UnitX(), x_m), kSmall, kAtOrigin);
    ASSERT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kFused);
    const double across_m = 0.5 * resolution_m;
    const auto sample = map.sample_at({x_m, across_m, across_m});
    ASSERT_TRUE(sample) << resolution_m;
    const double centre_m = (sample->voxel.x() + 0.5) * resolution_m;
    EXPECT_NEAR(sample->distance_m, x_m - centre_m, 1e-4 + 1e-4 * resolution_m) << resolution_m;
    EXPECT_EQ(map.occupancy_at({0.5 * x_m, across_m, across_m}), Occupancy::kFree) << resolution_m;
  }
}

TEST(FusionEdges, ASettledColourStandsAgainstOneFrameAndFollowsMany) {
  StaticMap map(0.02);
  const Eigen::Vector3d on_wall(1.01, 0.01, 0.01);
  Frame grey = wall_at(1.01, {100, 100, 100});
  for (grey.index = 0; grey.index < 40; ++grey.index) map.fuse(grey, kAtOrigin);
  EXPECT_EQ(map.sample_at(on_wall)->colour, (Rgb{100, 100, 100}));
  Frame white = wall_at(1.01, {250, 250, 250});
  white.index = 40;
  map.fuse(white, kAtOrigin);
  EXPECT_LE(map.sample_at(on_wall)->colour.r, 120);  // at most an eighth of the way
  for (white.index = 41; white.index < 700; ++white.index) map.fuse(white, kAtOrigin);
  EXPECT_GE(map.sample_at(on_wall)->colour.r, 240);
}

// Lists a tree's content, for comparison with another tree's.
std::vector<std::array<int, 9>> content(const BlockOctree& tree) {
  std::vector<std::array<int, 9>> all;
  for_each_leaf(tree, [&](const NodePlace& place, LogOdds log_odds) {
    all.push_back({place.key.x(), place.key.y(), place.key.z(), static_cast<int>(place.depth), log_odds});
  });
  for_each_part(
      tree, tree.root, {}, [](const NodePlace&, LogOdds) {},
      [&](const NodePlace& place, const LeafBlock& block) {
        for (unsigned i = 0; i < 8; ++i) {
          const Rgb colour = tree.colour(block, i);
          all.push_back({place.key.x(), place.key.y(), place.key.z(), static_cast<int>(i), block.distance[i],
                         block.weight[i], colour.r, colour.g, colour.b});
        }
      });
  return all;
}

TEST(FusionEdges, PlainAndFastestArithmeticMakeTheSameMapBitForBit) {
  const FusionConfig config;
  BlockOctree fastest(0.02, config), plain(0.02, config);
  FusionScratch scratch;
  std::mt19937 random(11);
  std::normal_distribution<float> noise_m(0.0F, 0.005F);
  const test::Scene scene = test::nearest_of(
      test::nearest_of(test::sphere({1.5, 0.1, 0}, 0.4),
                       test::box({Eigen::Vector3d(1.2, -0.9, -0.6), Eigen::Vector3d(1.9, -0.4, 0.3)})),
      test::plane(Eigen::Vector3d::UnitX(), 2.5));
  for (int i = 0; i < 6; ++i) {
    const Eigen::Isometry3d T_world_camera =
        looking_at({-0.1 * i, 0.07 * i, 0.03 * i}, {1.5, -0.1, 0.02 * i});
    Frame frame = exact_frame(scene, kCamera, T_world_camera, Rgb{static_cast<std::uint8_t>(40 * i), 9, 99});
    frame.index = i;
    for (float& depth_m : frame.depth_m.pixels)
      depth_m = random() % 12 == 0 ? 0.0F : std::max(depth_m + noise_m(random), 0.1F);
    ASSERT_EQ(collect_hits(frame, T_world_camera, 0.02, config, scratch), HitStatus::kCollected);
    build_pyramid(frame.depth_m, 0.02, config, scratch.pyramid);
    fuse_depth(fastest, frame, T_world_camera, config, scratch, {1, Arithmetic::kFastest});
    fuse_depth(plain, frame, T_world_camera, config, scratch, {3, Arithmetic::kPortable});
  }
  const auto a = content(fastest), b = content(plain);
  EXPECT_GT(a.size(), 50'000U);
  EXPECT_EQ(a, b);
}

TEST(FusionEdges, PreparedFramesMakeTheSameMapAndFailLikeOthers) {
  const test::TemporaryFolder folder;
  StaticMap at_once(0.02), in_two_steps(0.02);
  PreparedFrame now, next;
  const auto pose = [](int i) { return looking_at({-0.1 * i, 0.07 * i, 0.0}, {1.5, 0, 0}); };
  const auto frame = [](int i) { return wall_at(2.0 + 0.01 * i, {9, static_cast<std::uint8_t>(40 * i), 9}); };
  in_two_steps.prepare(frame(0), pose(0), now);
  for (int i = 0; i < 6; ++i) {
    ASSERT_EQ(at_once.fuse(frame(i), pose(i)), FuseStatus::kFused);
    auto preparing =
        std::async(std::launch::async, [&] { in_two_steps.prepare(frame(i + 1), pose(i + 1), next); });
    ASSERT_EQ(in_two_steps.fuse(frame(i), now), FuseStatus::kFused);
    preparing.get();
    std::swap(now, next);
  }
  at_once.write(folder.path() / "at_once");
  in_two_steps.write(folder.path() / "in_two_steps");
  EXPECT_EQ(read_bytes(folder.path() / "at_once", "a map"),
            read_bytes(folder.path() / "in_two_steps", "a map"));

  Eigen::Isometry3d skewed = pose(0);
  skewed.linear() *= 1.1;
  in_two_steps.prepare(frame(0), skewed, now);
  EXPECT_EQ(in_two_steps.fuse(frame(0), now), FuseStatus::kInvalidPose);
  Frame empty = frame(0);
  for (float& depth_m : empty.depth_m.pixels) depth_m = 0.0F;
  in_two_steps.prepare(empty, pose(0), now);
  EXPECT_EQ(in_two_steps.fuse(empty, now), FuseStatus::kNothingMeasured);
  EXPECT_EQ(in_two_steps.fuse(frame(0), PreparedFrame()), FuseStatus::kNothingMeasured);
  in_two_steps.prepare(frame(0), pose(0), now);
  EXPECT_EQ(in_two_steps.fuse(frame(0), now), FuseStatus::kFused) << "after faults, it can be used again";
}

TEST(BlockOctree, OnePlaceLeavesNothingBehindWhenItIsFreedAgain) {
  // Nodes that a ball in mid-air created are pruned once it is gone, and their blocks are reused.
  StaticMap map(0.02);
  const Frame without = wall_at(2.5);
  for (int i = 0; i < 10; ++i) map.fuse(without, kAtOrigin);
  const std::size_t nodes = map.counts().nodes;
  const Frame with = exact_frame(
      test::nearest_of(test::sphere({1.5, 0, 0}, 0.1), test::plane(Eigen::Vector3d::UnitX(), 2.5)), kCamera,
      kAtOrigin);
  map.fuse(with, kAtOrigin);
  EXPECT_GT(map.counts().nodes, nodes + 500);
  for (int i = 0; i < 60; ++i) map.fuse(without, kAtOrigin);
  EXPECT_LT(map.counts().nodes, nodes + nodes / 50);
  const std::size_t bytes = map.memory_bytes();
  for (int round = 0; round < 5; ++round) {
    map.fuse(with, kAtOrigin);
    for (int i = 0; i < 60; ++i) map.fuse(without, kAtOrigin);
  }
  EXPECT_LE(map.memory_bytes(), bytes + bytes / 20);
}

TEST(OctoMapTree, OctoMapReadsLogOddsDistancesAndColoursFromOurFile) {
  const test::TemporaryFolder folder;
  const auto path = folder.path() / "room.ot";
  StaticMap map(0.02);
  for (int i = 0; i < 3; ++i) map.fuse(wall_at(1.51), kAtOrigin);
  map.write_ot(path);
  const std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(path.string()));
  auto* tree = dynamic_cast<OctoMapTree*>(any.get());
  ASSERT_TRUE(tree);
  int samples = 0;
  map.visit_samples([&](const SurfaceSample& sample) {
    const Eigen::Vector3d p = (sample.voxel.cast<double>().array() + 0.5) * 0.02;
    const OctoMapNode* node = tree->search(p.x(), p.y(), p.z());
    ASSERT_TRUE(node);
    ASSERT_EQ(node->distance_m, sample.distance_m);
    ASSERT_EQ(node->weight, sample.weight);
    ASSERT_EQ(node->colour, sample.colour);
    ASSERT_EQ(node->colour_count > 0, sample.has_colour);
    ++samples;
  });
  EXPECT_GT(samples, 10'000);
  float greatest = -10.0F;
  map.visit_leaves([&](const MapLeaf& leaf) { greatest = std::max(greatest, leaf.log_odds); });
  EXPECT_EQ(tree->getRoot()->getLogOdds(), greatest);  // inner nodes store their children's maximum
}

TEST(OctoMapTree, AWorldOfOneCubeIsWrittenInBothForms) {
  const test::TemporaryFolder folder;
  StaticMap map(0.05);
  map.add_evidence(MapLeaf{{-32768, -32768, -32768}, 65536, -1.0F});
  EXPECT_EQ(map.counts().nodes, 1U);
  map.write_ot(folder.path() / "all.ot");
  const std::unique_ptr<octomap::AbstractOcTree> own(
      octomap::AbstractOcTree::read((folder.path() / "all.ot").string()));
  ASSERT_TRUE(own);
  EXPECT_EQ(own->size(), 1U);
  map.write_bt(folder.path() / "all.bt");
  octomap::OcTree plain(0.1);
  ASSERT_TRUE(plain.readBinary((folder.path() / "all.bt").string()));
  const octomap::OcTreeNode* node = plain.search(100.0, -5.0, 3.0);
  ASSERT_TRUE(node);
  EXPECT_FALSE(plain.isNodeOccupied(node));
}

}  // namespace
}  // namespace roomradar::fusion_edges_test
