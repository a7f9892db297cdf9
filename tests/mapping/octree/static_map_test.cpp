// static_map_test.cpp: state of the octree after fusing, its limits, and its files.
#include "mapping/octree/static_map.hpp"

#include <gtest/gtest.h>
#include <octomap/OcTree.h>

#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/map_content.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::static_map_test {
namespace {

using test::error_of;
using test::exact_frame;
using test::expect_equal;
using test::looking_at;
using test::samples_of;

constexpr Intrinsics kCamera{320, 240, 290.0, 290.0, 159.5, 119.5};
const Eigen::Isometry3d kAtOrigin = looking_at({0, 0, 0}, {1, 0, 0});  // along +x

Frame wall_at(double x_m) {
  return exact_frame(test::plane(Eigen::Vector3d::UnitX(), x_m), kCamera, kAtOrigin, Rgb{200, 100, 50});
}

TEST(StaticMap, BeforeAWallIsFreeTheWallOccupiedTheRestUnknown) {
  StaticMap map(0.02);
  ASSERT_EQ(map.fuse(wall_at(2.01), kAtOrigin), FuseStatus::kFused);
  for (double x_m = 0.3; x_m < 1.97; x_m += 0.05)
    EXPECT_EQ(map.occupancy_at({x_m, 0.05, 0.05}), Occupancy::kFree) << x_m;
  EXPECT_EQ(map.occupancy_at({2.01, 0.3, -0.3}), Occupancy::kOccupied);
  for (double x_m = 2.05; x_m < 4.0; x_m += 0.05)
    EXPECT_EQ(map.occupancy_at({x_m, 0.05, 0.05}), Occupancy::kUnknown) << x_m;
  EXPECT_EQ(map.occupancy_at({1.0, 1.0, 0.0}), Occupancy::kUnknown);   // beside the view
  EXPECT_EQ(map.occupancy_at({-0.5, 0.0, 0.0}), Occupancy::kUnknown);  // behind the camera
}

TEST(StaticMap, SignedDistanceIsTheDistanceToTheWall) {
  StaticMap map(0.01);
  ASSERT_EQ(map.fuse(wall_at(1.503), kAtOrigin), FuseStatus::kFused);
  int checked = 0;
  map.visit_samples([&](const SurfaceSample& sample) {
    const double centre_x_m = (sample.voxel.x() + 0.5) * 0.01;
    ASSERT_NEAR(sample.distance_m, 1.503 - centre_x_m, 1e-5);  // float depth at 1.5 m
    ASSERT_LE(std::abs(sample.distance_m), 0.02 + 1e-5);       // the truncation, two voxels
    if (std::abs(sample.distance_m) < 0.015F && sample.has_colour) {
      ASSERT_EQ(sample.colour, (Rgb{200, 100, 50}));
    }
    ++checked;
  });
  // 320 x 240 pixels at 1.503 m cover 166 x 124 voxels, 4 of them deep; one row may be outside the view.
  EXPECT_NEAR(checked, 166 * 124 * 4, 166 * 4);
}

TEST(StaticMap, FusingTwiceClassifiesAsOnce) {
  StaticMap once(0.02), twice(0.02);
  const Frame frame = exact_frame(
      test::nearest_of(test::sphere({1.5, 0, 0}, 0.4), test::plane(Eigen::Vector3d::UnitX(), 2.5)), kCamera,
      kAtOrigin);
  once.fuse(frame, kAtOrigin);
  twice.fuse(frame, kAtOrigin);
  twice.fuse(frame, kAtOrigin);
  for (double x_m = -0.5; x_m < 3.0; x_m += 0.037)
    for (double y_m = -1.0; y_m < 1.0; y_m += 0.041)
      ASSERT_EQ(once.occupancy_at({x_m, y_m, 0.1}), twice.occupancy_at({x_m, y_m, 0.1})) << x_m << " " << y_m;
}

TEST(StaticMap, ScatteredInvalidPixelsDoNotBlockFreeing) {
  Frame holed = wall_at(2.0);
  std::mt19937 random(1);
  for (float& depth_m : holed.depth_m.pixels)
    if (random() % 10 == 0) depth_m = 0.0F;
  StaticMap whole(0.02), with_holes(0.02);
  whole.fuse(wall_at(2.0), kAtOrigin);
  with_holes.fuse(holed, kAtOrigin);
  int free = 0, missed = 0;
  for (double x_m = 0.5; x_m < 1.9; x_m += 0.02)
    for (double y_m = -0.2; y_m < 0.2; y_m += 0.02)
      for (double z_m = -0.15; z_m < 0.15; z_m += 0.02)
        if (whole.occupancy_at({x_m, y_m, z_m}) == Occupancy::kFree) {
          ++free;
          missed += with_holes.occupancy_at({x_m, y_m, z_m}) != Occupancy::kFree;
        }
  EXPECT_GT(free, 10'000);
  EXPECT_LT(missed, free / 100);
}

TEST(StaticMap, ALargeHoleStaysUnknown) {
  Frame holed = wall_at(2.0);
  for (int y = 80; y < 160; ++y)
    for (int x = 120; x < 200; ++x) holed.depth_m.at(x, y) = 0.0F;
  StaticMap map(0.02);
  map.fuse(holed, kAtOrigin);
  EXPECT_EQ(map.occupancy_at({1.0, 0.0, 0.0}), Occupancy::kUnknown);
  EXPECT_EQ(map.occupancy_at({1.0, 0.3, 0.0}), Occupancy::kFree);
}

TEST(StaticMap, WhatWasTakenAwayLosesItsSurface) {
  StaticMap map(0.02);
  const Frame with_ball = exact_frame(
      test::nearest_of(test::sphere({1.5, 0, 0}, 0.2), test::plane(Eigen::Vector3d::UnitX(), 2.5)), kCamera,
      kAtOrigin);
  const Frame without = wall_at(2.5);
  for (int i = 0; i < 3; ++i) map.fuse(with_ball, kAtOrigin);
  EXPECT_EQ(map.occupancy_at({1.31, 0, 0}), Occupancy::kOccupied);
  for (int i = 0; i < 20; ++i) map.fuse(without, kAtOrigin);
  EXPECT_EQ(map.occupancy_at({1.31, 0, 0}), Occupancy::kFree);
  map.visit_samples([&](const SurfaceSample& sample) {
    if (sample.voxel.x() < 100) {
      ASSERT_GT(sample.distance_m, 0.0F) << "a surface of the ball is left at x = " << sample.voxel.x();
    }
  });
}

TEST(StaticMap, CameraInsideAnOccupiedVoxelStillFusesWhatItSees) {
  StaticMap map(0.05);
  map.fuse(wall_at(1.0), kAtOrigin);
  const Eigen::Isometry3d in_the_wall = looking_at({1.01, 0, 0}, {2, 0, 0});
  ASSERT_EQ(map.occupancy_at(in_the_wall.translation()), Occupancy::kOccupied);
  EXPECT_EQ(
      map.fuse(exact_frame(test::plane(Eigen::Vector3d::UnitX(), 3.0), kCamera, in_the_wall), in_the_wall),
      FuseStatus::kFused);
  EXPECT_EQ(map.occupancy_at({2.0, 0, 0}), Occupancy::kFree);
  EXPECT_EQ(map.occupancy_at({3.01, 0, 0}), Occupancy::kOccupied);
}

TEST(StaticMap, TheSameFrameTenThousandTimesStaysFiniteAndInPlace) {
  constexpr Intrinsics kSmall{16, 12, 15.0, 15.0, 7.5, 5.5};
  const Frame frame =
      exact_frame(test::plane(Eigen::Vector3d::UnitX(), 1.503), kSmall, kAtOrigin, Rgb{9, 99, 199});
  StaticMap map(0.05);
  map.fuse(frame, kAtOrigin);
  const std::vector<SurfaceSample> first = samples_of(map);
  for (int i = 1; i < 10'000; ++i) ASSERT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kFused);
  const std::vector<SurfaceSample> last = samples_of(map);
  ASSERT_EQ(first.size(), last.size());
  for (std::size_t i = 0; i < last.size(); ++i) {
    ASSERT_NEAR(last[i].distance_m, first[i].distance_m, 1e-6);
    ASSERT_LE(last[i].weight, map.config().max_weight);
    ASSERT_EQ(last[i].colour, first[i].colour);
    ASSERT_EQ(last[i].occupancy, first[i].occupancy);
  }
}

TEST(StaticMap, FramesThatCannotBeFusedChangeNothingAndSayWhy) {
  StaticMap map(0.01);
  Frame frame = wall_at(2.0);
  EXPECT_EQ(map.fuse(frame, looking_at({400, 0, 0}, {401, 0, 0})), FuseStatus::kOutOfBounds);
  // only its wall is
  EXPECT_EQ(map.fuse(frame, looking_at({327, 0, 0}, {328, 0, 0})), FuseStatus::kOutOfBounds);
  EXPECT_EQ(map.fuse(frame, looking_at({1e30, 0, 0}, {2e30, 0, 0})), FuseStatus::kOutOfBounds);
  Eigen::Isometry3d bad = kAtOrigin;
  bad.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(map.fuse(frame, bad), FuseStatus::kInvalidPose);
  bad = kAtOrigin;
  bad.linear() *= 2.0;
  EXPECT_EQ(map.fuse(frame, bad), FuseStatus::kInvalidPose);
  frame.depth_camera.width_px = 640;
  EXPECT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kInvalidFrame);
  frame = wall_at(2.0);
  frame.depth_m.resize(320, 240);
  EXPECT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kNothingMeasured);
  EXPECT_EQ(map.fuse(Frame{}, kAtOrigin), FuseStatus::kInvalidFrame);
  for (const Intrinsics& vast :
       {Intrinsics{4097, 2, 500, 500, 2048, 0.5}, Intrinsics{2, 4097, 500, 500, 0.5, 2048}}) {
    frame.depth_camera = vast;
    frame.depth_m = DepthImage(vast.width_px, vast.height_px, 2.0F);
    EXPECT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kInvalidFrame);
  }
  EXPECT_EQ(map.counts().nodes, 0U);
  EXPECT_EQ(map.occupancy_at({0, 0, std::numeric_limits<double>::quiet_NaN()}), Occupancy::kUnknown);
  EXPECT_EQ(map.occupancy_at({1e9, 0, 0}), Occupancy::kUnknown);
}

TEST(StaticMap, OneValidPixelIsOneSurface) {
  Frame frame = wall_at(1.0);
  frame.depth_m.resize(320, 240);
  frame.depth_m.at(160, 120) = 1.0F;
  StaticMap map(0.01);
  ASSERT_EQ(map.fuse(frame, kAtOrigin), FuseStatus::kFused);
  EXPECT_EQ(map.counts().occupied_leaves, 1U);
}

TEST(StaticMap, FarFromTheOriginTheMapIsTheSame) {
  const Eigen::Vector3d shift(300.0, -300.0, 300.0);
  StaticMap near(0.01), far(0.01);
  const test::Scene ball = test::sphere({1.2, 0, 0}, 0.3);
  const Frame frame = exact_frame(ball, kCamera, kAtOrigin);
  near.fuse(frame, kAtOrigin);
  Eigen::Isometry3d far_away = kAtOrigin;
  far_away.translation() += shift;
  ASSERT_EQ(far.fuse(frame, far_away), FuseStatus::kFused);
  const std::vector<SurfaceSample> a = samples_of(near), b = samples_of(far);
  // A centre that projects between two pixels may use either.
  EXPECT_NEAR(static_cast<double>(a.size()), static_cast<double>(b.size()),
              0.001 * static_cast<double>(a.size()));
  int compared = 0;
  for (const SurfaceSample& sample : a) {
    const auto other = far.sample_at((sample.voxel.cast<double>().array() + 0.5).matrix() * 0.01 + shift);
    if (!other) continue;
    compared += std::abs(other->distance_m - sample.distance_m) < 1e-4F;
  }
  EXPECT_GT(compared, 0.98 * static_cast<double>(a.size()));
}

TEST(StaticMap, EachResolutionWithinTheRulesWorksAndOthersAreNamed) {
  for (const double resolution_m : {0.001, 0.0123456789, 0.1, 1.0}) {
    constexpr Intrinsics kSmall{32, 24, 30.0, 30.0, 15.5, 11.5};
    StaticMap map(resolution_m);
    ASSERT_EQ(map.fuse(exact_frame(test::plane(Eigen::Vector3d::UnitX(), 0.5), kSmall, kAtOrigin), kAtOrigin),
              FuseStatus::kFused);
    EXPECT_GT(map.counts().occupied_leaves, 0U) << resolution_m;
  }
  for (const double bad : {0.0, -0.01, 0.0005, 2.0, std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity()})
    EXPECT_NE(error_of([&] { StaticMap{bad}; }).find("must be between 0.001 and 1 m"), std::string::npos)
        << bad;
  EXPECT_NE(error_of([] { StaticMap(0.01, {.max_range_m = -1.0F}); }).find("max_range_m"), std::string::npos);
}

// Rebuilds a map from another map's leaves and samples.
StaticMap rebuilt(const StaticMap& from) {
  StaticMap to(from.resolution_m());
  from.visit_leaves([&](const MapLeaf& leaf) { to.add_evidence(leaf); });
  from.visit_samples([&](const SurfaceSample& sample) { to.add_evidence(sample); });
  return to;
}

TEST(StaticMap, ItsLeavesAndSamplesAreAllThereIs) {
  StaticMap map(0.02);
  map.fuse(exact_frame(
               test::nearest_of(test::sphere({1.5, 0, 0}, 0.4), test::plane(Eigen::Vector3d::UnitX(), 2.5)),
               kCamera, kAtOrigin, Rgb{7, 8, 9}),
           kAtOrigin);
  expect_equal(map, rebuilt(map));
}

TEST(StaticMap, LeavesTileWhatIsKnownInMortonOrder) {
  StaticMap map(0.02);
  map.fuse(wall_at(2.01), kAtOrigin);
  std::size_t free = 0, occupied = 0, largest = 0;
  map.visit_leaves([&](const MapLeaf& leaf) {
    const Eigen::Vector3d middle =
        (leaf.lowest_voxel.cast<double>().array() + 0.5 * leaf.edge_voxels).matrix() * map.resolution_m();
    ASSERT_EQ(map.occupancy_at(middle), leaf.log_odds > 0.0F ? Occupancy::kOccupied : Occupancy::kFree);
    ++(leaf.log_odds > 0.0F ? occupied : free);
    largest = std::max(largest, static_cast<std::size_t>(leaf.edge_voxels));
  });
  EXPECT_EQ(free, map.counts().free_leaves);
  EXPECT_EQ(occupied, map.counts().occupied_leaves);
  EXPECT_GE(largest, 8U);  // 16 cm of free space
}

TEST(StaticMap, EvidenceAddsUpWithinTheClampingAndCubesReachEveryVoxel) {
  StaticMap map(0.02);
  map.fuse(wall_at(2.01), kAtOrigin);
  const MapLeaf cube{{96, -16, -16}, 16, -1.0F};  // x in 1.92..2.24 m: through the wall
  for (int i = 0; i < 20; ++i) map.add_evidence(cube);
  for (double x_m = 1.93; x_m < 2.24; x_m += 0.02)
    EXPECT_EQ(map.occupancy_at({x_m, -0.01, -0.01}), Occupancy::kFree);
  EXPECT_EQ(map.occupancy_at({2.01, 0.4, 0}), Occupancy::kOccupied);
  map.visit_leaves([&](const MapLeaf& leaf) {
    ASSERT_GE(leaf.log_odds, map.config().min_log_odds - 1e-3F);
    ASSERT_LE(leaf.log_odds, map.config().max_log_odds + 1e-3F);
  });
  map.add_evidence(MapLeaf{{100, -1, -1}, 1, 9.0F});
  EXPECT_EQ(map.occupancy_at({2.01, -0.01, -0.01}), Occupancy::kOccupied);
}

TEST(StaticMap, SamplesOfTwoMapsMeetByTheirWeights) {
  StaticMap map(0.02);
  map.add_evidence(SurfaceSample{
      .voxel = {5, 5, 5}, .distance_m = 0.01F, .weight = 3.0F, .colour = {10, 0, 90}, .has_colour = true});
  map.add_evidence(SurfaceSample{
      .voxel = {5, 5, 5}, .distance_m = 0.03F, .weight = 1.0F, .colour = {50, 0, 10}, .has_colour = true});
  const auto sample = map.sample_at({0.11, 0.11, 0.11});
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->distance_m, 0.015F, 1e-5);
  EXPECT_NEAR(sample->weight, 4.0F, 0.05);
  EXPECT_EQ(sample->colour, (Rgb{20, 0, 70}));
  EXPECT_EQ(sample->occupancy, Occupancy::kUnknown);
}

TEST(StaticMap, EvidenceThatCannotBeIsNamed) {
  StaticMap map(0.02);
  for (const MapLeaf& bad :
       {MapLeaf{{0, 0, 0}, 3, 1.0F}, MapLeaf{{1, 0, 0}, 2, 1.0F}, MapLeaf{{32768, 0, 0}, 1, 1.0F},
        MapLeaf{{0, 0, 0}, 0, 1.0F}, MapLeaf{{0, 0, 0}, -4, 1.0F}})
    EXPECT_NE(error_of([&] { map.add_evidence(bad); }).find("not a leaf of an octree"), std::string::npos);
  EXPECT_NE(error_of([&] {
              map.add_evidence(MapLeaf{{0, 0, 0}, 1, std::nanf("")});
            }).find("finite"),
            std::string::npos);
  EXPECT_NE(error_of([&] { map.add_evidence(SurfaceSample{.weight = 0.0F}); }).find("weight"),
            std::string::npos);
  EXPECT_EQ(map.counts().nodes, 0U);
}

class StaticMapFile : public ::testing::Test {
 protected:
  StaticMapFile() : map_(0.0123456789) {
    const test::Scene scene =
        test::nearest_of(test::sphere({1.5, 0, 0}, 0.4), test::plane(Eigen::Vector3d::UnitX(), 2.5));
    map_.fuse(exact_frame(scene, kCamera, kAtOrigin, Rgb{1, 2, 3}), kAtOrigin);
    map_.write_ot(path_);
  }
  [[nodiscard]] std::string bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::string message_for(const std::string& content) {
    std::ofstream(path_, std::ios::binary) << content;
    return error_of([&] { StaticMap::read_ot(path_); });
  }
  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "room.ot";
  StaticMap map_;
};

TEST_F(StaticMapFile, ReadsBackEqualInEveryBit) {
  const StaticMap read = StaticMap::read_ot(path_);
  EXPECT_EQ(read.resolution_m(), map_.resolution_m());
  expect_equal(map_, read);
}

TEST_F(StaticMapFile, GoesOnFusingAfterReadingAsIfNeverSaved) {
  StaticMap read = StaticMap::read_ot(path_);
  const Frame next = wall_at(2.2);
  read.fuse(next, kAtOrigin);
  map_.fuse(next, kAtOrigin);
  expect_equal(map_, read);
}

TEST_F(StaticMapFile, OctoMapItselfReadsBothForms) {
  const std::unique_ptr<octomap::AbstractOcTree> own(octomap::AbstractOcTree::read(path_.string()));
  ASSERT_TRUE(own);
  EXPECT_EQ(own->getTreeType(), "RoomRadarOcTree");
  EXPECT_EQ(own->size(), map_.counts().nodes);

  const std::filesystem::path plain_path = folder_.path() / "room.bt";
  map_.write_bt(plain_path);
  octomap::OcTree plain(0.1);
  ASSERT_TRUE(plain.readBinary(plain_path.string()));
  EXPECT_DOUBLE_EQ(plain.getResolution(), map_.resolution_m());
  int known = 0;
  for (double x_m = -0.5; x_m < 3.0; x_m += 0.031)
    for (double y_m = -1.5; y_m < 1.5; y_m += 0.037)
      for (double z_m = -1.0; z_m < 1.0; z_m += 0.041) {
        const octomap::OcTreeNode* node = plain.search(x_m, y_m, z_m);
        const Occupancy expected = !node                        ? Occupancy::kUnknown
                                   : plain.isNodeOccupied(node) ? Occupancy::kOccupied
                                                                : Occupancy::kFree;
        ASSERT_EQ(map_.occupancy_at({x_m, y_m, z_m}), expected) << x_m << " " << y_m << " " << z_m;
        known += node != nullptr;
      }
  EXPECT_GT(known, 10'000);
}

TEST_F(StaticMapFile, AnEmptyMapSurvives) {
  StaticMap(0.05).write_ot(path_);
  EXPECT_EQ(StaticMap::read_ot(path_).counts().nodes, 0U);
  StaticMap(0.05).write_bt(folder_.path() / "empty.bt");
  octomap::OcTree plain(0.1);
  EXPECT_TRUE(plain.readBinary((folder_.path() / "empty.bt").string()));
}

TEST_F(StaticMapFile, WhatIsBrokenIsNamedAndNeverCrashes) {
  const std::string good = bytes();
  EXPECT_NE(error_of([&] { StaticMap::read_ot(folder_.path() / "none.ot"); }).find("none.ot"),
            std::string::npos);
  EXPECT_NE(error_of([&] { StaticMap::read_ot(folder_.path()); }).find("is not a regular file"),
            std::string::npos);
  EXPECT_NE(message_for("").find("not an octree file"), std::string::npos);
  EXPECT_NE(message_for("hello\n").find("not an octree file"), std::string::npos);
  EXPECT_NE(message_for(good.substr(0, good.size() - 1)).find("cut short"), std::string::npos);
  EXPECT_NE(message_for(good.substr(0, good.size() / 2)).find("cut short"), std::string::npos);
  EXPECT_NE(message_for(good + "x").find("after its end"), std::string::npos);
  std::string other = good;
  other.replace(other.find("RoomRadarOcTree"), 15, "ColorOcTree    ");
  EXPECT_NE(message_for(other).find("ColorOcTree"), std::string::npos);
  other = good;
  other.replace(other.find("res 0"), 5, "res 9");
  EXPECT_NE(message_for(other).find("resolution"), std::string::npos);
  // A file of child masks only: deeper than any octree, and endless for a reader that trusts it.
  std::string deep = good.substr(0, good.find("data\n") + 5);
  for (int i = 0; i < 100'000; ++i) deep += std::string("\x00\x00\x80\x3f\x00\xff", 6);
  EXPECT_NE(message_for(deep).find("damaged"), std::string::npos);
}

TEST_F(StaticMapFile, ACubeThatNoSensorSeesIsNamed) {
  const auto read_again = [&](const MapLeaf& cube) {
    StaticMap map(0.02);
    map.add_evidence(cube);
    map.write_ot(path_);
    return StaticMap::read_ot(path_).counts();
  };
  EXPECT_EQ(read_again({{0, 0, 0}, 8192, -1.0F}).free_leaves, 1U);    // 164 m of free space
  EXPECT_EQ(read_again({{0, 0, 0}, 128, 1.0F}).occupied_leaves, 1U);  // 2.56 m of solid
  for (const MapLeaf& absurd : {MapLeaf{{-32768, -32768, -32768}, 65536, 1.0F},
                                MapLeaf{{0, 0, 0}, 16384, -1.0F}, MapLeaf{{0, 0, 0}, 256, 1.0F}})
    EXPECT_NE(error_of([&] { read_again(absurd); }).find("damaged: node"), std::string::npos);
}

TEST_F(StaticMapFile, RandomDamageNeverCrashes) {
  const std::string good = bytes().substr(0, 20'000);
  std::mt19937 random(7);
  for (int round = 0; round < 2'000; ++round) {
    std::string bad = good;
    for (int i = 0; i < 4; ++i) bad[random() % bad.size()] = static_cast<char>(random());
    ASSERT_NE(message_for(bad), "");
  }
}

}  // namespace
}  // namespace roomradar::static_map_test
