// fusion_test.cpp: fusion by octree descent against OctoMap's ray casting, and the depth pyramid and voxel
// keys it uses.
#include "mapping/octree/fusion.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <random>

#include "mapping/octree/static_map.hpp"
#include "mapping/types/voxel_key.hpp"
#include "tests/support/exact_depth.hpp"

namespace roomradar::fusion_test {
namespace {

using test::exact_frame;
using test::looking_at;

// As in OctoMap: every ray of every pixel.
void insert_rays(octomap::OcTree& tree, const Frame& frame, const Eigen::Isometry3d& T_world_camera) {
  octomap::Pointcloud cloud;
  for (int y = 0; y < frame.depth_m.height; ++y)
    for (int x = 0; x < frame.depth_m.width; ++x) {
      if (frame.depth_m.at(x, y) == 0.0F) continue;
      const Eigen::Vector3f p =
          (T_world_camera * back_project(frame.depth_camera, x, y, frame.depth_m.at(x, y))).cast<float>();
      cloud.push_back(p.x(), p.y(), p.z());
    }
  const Eigen::Vector3f eye = T_world_camera.translation().cast<float>();
  tree.insertPointCloud(cloud, {eye.x(), eye.y(), eye.z()});
}

TEST(Fusion, AgreesWithOctoMapsInsertPointCloud) {
  // A box and a ball on a floor in front of a wall, from three sides. Each voxel is several pixels wide;
  // otherwise OctoMap's rays leave gaps that an image does not have.
  const test::Scene room = test::nearest_of(
      test::nearest_of(
          test::box({Eigen::Vector3d(-0.404, 1.307, -0.1), Eigen::Vector3d(0.013, 1.707, 0.494)}),
          test::sphere({0.4, 1.5, 0.25}, 0.25)),
      test::nearest_of(test::plane(Eigen::Vector3d::UnitZ(), -0.013),
                       test::plane(Eigen::Vector3d::UnitY(), 2.617)));
  constexpr Intrinsics kCamera{640, 480, 585.0, 585.0, 319.5, 239.5};
  constexpr double kResolution_m = 0.03;
  StaticMap map(kResolution_m);
  octomap::OcTree reference(kResolution_m);
  for (const Eigen::Vector3d& eye :
       {Eigen::Vector3d(0.013, 0.007, 0.91), {-0.9, 0.3, 1.2}, {1.1, 0.4, 0.7}}) {
    const Eigen::Isometry3d T_world_camera = looking_at(eye, {0.0, 1.6, 0.3});
    Frame frame = exact_frame(room, kCamera, T_world_camera);
    for (float& depth_m : frame.depth_m.pixels)
      if (depth_m > map.config().max_range_m) depth_m = 0.0F;
    ASSERT_EQ(map.fuse(frame, T_world_camera), FuseStatus::kFused);
    insert_rays(reference, frame, T_world_camera);
  }
  int known_to_both = 0, agree = 0, occupied = 0, kept = 0, unknown = 0, made_free = 0;
  for (double x = -2.0; x < 2.0; x += kResolution_m)
    for (double y = -0.5; y < 3.0; y += kResolution_m)
      for (double z = -0.2; z < 2.0; z += kResolution_m) {
        const Occupancy ours = map.occupancy_at({x, y, z});
        const octomap::OcTreeNode* node = reference.search(x, y, z);
        if (!node) {
          ++unknown;
          made_free += ours == Occupancy::kFree;
          continue;
        }
        const bool is_occupied = reference.isNodeOccupied(node);
        if (is_occupied) {
          ++occupied;
          kept += ours == Occupancy::kOccupied;
        }
        if (ours == Occupancy::kUnknown) continue;
        ++known_to_both;
        agree += (ours == Occupancy::kOccupied) == is_occupied;
      }
  EXPECT_GT(known_to_both, 50'000);
  EXPECT_GT(occupied, 3'000);
  EXPECT_GE(agree, 0.99 * known_to_both);
  EXPECT_GE(kept, 0.99 * occupied);
  EXPECT_LE(made_free, 0.001 * unknown);
  RecordProperty("agree", std::to_string(static_cast<double>(agree) / known_to_both));
}

TEST(Fusion, HitsAreTheVoxelsOfAllEndPointsSortedEachOnce) {
  constexpr Intrinsics kCamera{64, 48, 60.0, 60.0, 31.5, 23.5};
  const Eigen::Isometry3d T_world_camera = looking_at({-3.21, 7.5, 1.1}, {0, 7, 0});
  Frame frame = exact_frame(test::sphere({0, 7, 0}, 1.0), kCamera, T_world_camera);
  FusionScratch scratch;
  ASSERT_EQ(collect_hits(frame, T_world_camera, 0.02, {}, scratch), HitStatus::kCollected);
  std::vector<std::uint64_t> expected;
  for (int y = 0; y < kCamera.height_px; ++y)
    for (int x = 0; x < kCamera.width_px; ++x) {
      if (frame.depth_m.at(x, y) == 0.0F) continue;
      const Eigen::Vector3d p = T_world_camera * back_project(kCamera, x, y, frame.depth_m.at(x, y));
      const Eigen::Array3i key = (p / 0.02).array().floor().cast<int>() + kKeyOrigin;
      expected.push_back(morton_code(static_cast<std::uint32_t>(key.x()), static_cast<std::uint32_t>(key.y()),
                                     static_cast<std::uint32_t>(key.z())));
    }
  std::sort(expected.begin(), expected.end());
  expected.erase(std::unique(expected.begin(), expected.end()), expected.end());
  std::vector<std::uint64_t> found;
  for (const BlockHits& hit : scratch.hits)
    for (unsigned i = 0; i < 8; ++i)
      if ((hit.voxels() >> i & 1U) != 0) found.push_back(hit.block_code() << 3U | i);
  std::vector<std::uint64_t> common;
  std::set_intersection(expected.begin(), expected.end(), found.begin(), found.end(),
                        std::back_inserter(common));
  EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
  EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
  EXPECT_GT(expected.size(), 500U);
  // Float against double: an end point on a voxel's border may fall on either side.
  EXPECT_GE(common.size() + 2, expected.size());
  EXPECT_LE(found.size(), expected.size() + 2);
}

TEST(MortonCode, DigitsAreOctoMapsChildIndices) {
  std::mt19937 random(3);
  for (int round = 0; round < 1000; ++round) {
    const octomap::OcTreeKey key(static_cast<octomap::key_type>(random()),
                                 static_cast<octomap::key_type>(random()),
                                 static_cast<octomap::key_type>(random()));
    const std::uint64_t code = morton_code(key[0], key[1], key[2]);
    for (unsigned depth = 0; depth < 16; ++depth)
      ASSERT_EQ(code >> (3 * (15 - depth)) & 7U, octomap::computeChildIdx(key, static_cast<int>(15 - depth)));
  }
}

TEST(DepthPyramid, BoundsHoldForEveryRectangle) {
  DepthImage depth_m(37, 23);
  std::mt19937 random(5);
  for (float& z : depth_m.pixels)
    z = random() % 4 == 0 ? 0.0F : 0.5F + static_cast<float>(random() % 4000) * 1e-3F;
  for (int y = 8; y < 16; ++y)
    for (int x = 8; x < 24; ++x) depth_m.at(x, y) = 0.0F;  // too wide for neighbours to fill
  const FusionConfig config;
  DepthPyramid pyramid;
  build_pyramid(depth_m, 0.01, config, pyramid);
  for (int round = 0; round < 20'000; ++round) {
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    const int left = below(37), top = below(23);
    const int right = left + below(37 - left), bottom = top + below(23 - top);
    int level = 1;
    while (std::max((right >> level) - (left >> level), (bottom >> level) - (top >> level)) > 3) ++level;
    const int across = (right >> level) - (left >> level), down = (bottom >> level) - (top >> level);
    const DepthBounds bounds = bounds_within(
        pyramid, {(pyramid.first_row(level) + (top >> level)) * pyramid.stride + (left >> level),
                  std::max(across - 1, 0), std::min(down, 1) * pyramid.stride,
                  std::max(down - 1, 0) * pyramid.stride, down * pyramid.stride});
    for (int y = top; y <= bottom; ++y)
      for (int x = left; x <= right; ++x) {
        const float z = depth_m.at(x, y);
        if (z == 0.0F) continue;
        const float half_m = TruncationBand(0.01, config).widest_m(z);
        ASSERT_LE(static_cast<float>(bounds.front), (z - half_m) * pyramid.steps_per_m);
        ASSERT_LE(static_cast<float>(bounds.nearest), (z - half_m) * pyramid.steps_per_m);
        ASSERT_GE(static_cast<float>(-bounds.behind), (z + half_m) * pyramid.steps_per_m);
      }
    // Space seen only through the hole is never free: either no depth is behind it, or the hole blocks.
    if (left >= 8 && right < 24 && top >= 8 && bottom < 16) {
      ASSERT_LE(std::min<int>(bounds.front, -bounds.behind), 1);
    }
  }
}

}  // namespace
}  // namespace roomradar::fusion_test
