// octree_file_test.cpp: the octree as compressed blocks: equal in every bit, and damaged files.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "mapping/octree/static_map.hpp"
#include "mapping/storage/compressed_columns.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/exact_depth.hpp"
#include "tests/support/map_content.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar::octree_file_test {
namespace {

using test::error_of;
using test::exact_frame;
using test::expect_equal;
using test::looking_at;

constexpr Intrinsics kCamera{320, 240, 290.0, 290.0, 159.5, 119.5};

/// A noisy frame of a ball before a wall that is far enough for coarse cells, seen from x_m.
Frame frame_from(double x_m, unsigned seed) {
  const test::Scene scene =
      test::nearest_of(test::sphere({1.5, 0, 0}, 0.4), test::plane(Eigen::Vector3d::UnitX(), 4.0));
  const Eigen::Isometry3d T_world_camera = looking_at({x_m, 0, 0}, {x_m + 1.0, 0, 0});
  Frame frame = exact_frame(scene, kCamera, T_world_camera, Rgb{});
  std::mt19937 random(seed);
  for (float& depth_m : frame.depth_m.pixels)
    if (depth_m > 0.0F) depth_m += static_cast<float>(random() % 1000) * 1e-5F;
  for (Rgb& colour : frame.colour.pixels)
    colour = {.r = static_cast<std::uint8_t>(random()),
              .g = static_cast<std::uint8_t>(random()),
              .b = static_cast<std::uint8_t>(random())};
  return frame;
}

void fuse_from(StaticMap& map, double x_m, unsigned seed) {
  ASSERT_EQ(map.fuse(frame_from(x_m, seed), looking_at({x_m, 0, 0}, {x_m + 1.0, 0, 0})), FuseStatus::kFused);
}

class OctreeFile : public ::testing::Test {
 protected:
  OctreeFile() {
    for (unsigned seed = 1; seed < 4; ++seed) fuse_from(map_, 0.05 * seed, seed);
    map_.write(path_);
  }
  [[nodiscard]] std::string as_ot(const StaticMap& map) const {
    map.write_ot(folder_.path() / "content.ot");
    return read_bytes(folder_.path() / "content.ot", "an octree");
  }
  std::string message_for(const std::string& content) {
    std::ofstream(path_, std::ios::binary) << content;
    return error_of([&] { static_cast<void>(StaticMap::read(path_)); });
  }
  /// Writes a file with this body, whose checksum is right. Returns the reader's message; empty if it reads.
  std::string message_for_body(const std::string& body) {
    write_binary(path_, "RROCTREE", 1, body);
    try {
      static_cast<void>(StaticMap::read(path_));
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }
  test::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "octree.bin";
  StaticMap map_{0.0123456789};
};

TEST_F(OctreeFile, ReadsBackEqualInEveryBit) {
  const StaticMap read = StaticMap::read(path_);
  EXPECT_EQ(read.resolution_m(), map_.resolution_m());
  expect_equal(map_, read);
  const std::string content = as_ot(map_);
  EXPECT_GT(content.size(), 3 * std::filesystem::file_size(path_));
  EXPECT_TRUE(content == as_ot(read));
}

TEST_F(OctreeFile, GoesOnFusingAfterReadingAsIfNeverSaved) {
  StaticMap read = StaticMap::read(path_);
  fuse_from(map_, 0.9, 17);
  fuse_from(read, 0.9, 17);
  EXPECT_TRUE(as_ot(map_) == as_ot(read));
}

TEST_F(OctreeFile, AnEmptyMapSurvives) {
  StaticMap(0.05).write(path_);
  const StaticMap read = StaticMap::read(path_);
  EXPECT_EQ(read.counts().nodes, 0U);
  EXPECT_EQ(read.resolution_m(), 0.05);
}

TEST_F(OctreeFile, OtherSettingsRoundToTheirSteps) {
  FusionConfig other;
  other.max_weight *= 2.0F;
  other.max_log_odds *= 3.0F;
  const StaticMap read = StaticMap::read(path_, other);
  const std::vector<SurfaceSample> before = test::samples_of(map_), after = test::samples_of(read);
  ASSERT_EQ(before.size(), after.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(before[i].voxel, after[i].voxel);
    EXPECT_NEAR(before[i].distance_m, after[i].distance_m, 1e-5F);
    EXPECT_NEAR(before[i].weight, after[i].weight, other.max_weight / 65535.0F);
    EXPECT_EQ(before[i].occupancy, after[i].occupancy);
  }
}

TEST_F(OctreeFile, WhatIsBrokenIsNamed) {
  const std::string good = read_bytes(path_, "an octree");
  EXPECT_NE(error_of([&] { StaticMap::read(folder_.path() / "none.bin"); }).find("none.bin: is missing"),
            std::string::npos);
  EXPECT_NE(message_for("").find("not a file of this kind"), std::string::npos);
  EXPECT_NE(message_for("RRPLACES" + good.substr(8)).find("not a file of this kind"), std::string::npos);
  EXPECT_NE(message_for(good.substr(0, good.size() / 2)).find("cut short or altered"), std::string::npos);
  EXPECT_NE(message_for(good + "x").find("cut short or altered"), std::string::npos);
}

/// The columns of a file. The default is a cube of free space, 8 voxels wide, deep in the tree.
struct Columns {
  double resolution_m = 0.02;
  float log_odds_step = 1e-4F;
  std::vector<std::uint16_t> kinds{2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1};
  std::vector<std::int16_t> cubes{-100};
  std::vector<std::int16_t> log_odds{};
  std::vector<std::uint8_t> sampled{}, coloured{};
  std::vector<std::uint16_t> distances{}, weights{};
  std::vector<std::uint8_t> red{}, green{}, blue{};
};

std::string body_of(const Columns& columns) {
  ByteWriter head;
  head(columns.resolution_m, columns.log_odds_step, 1e-6F, 1e-3F);
  std::string out = head.bytes;
  put_column(out, columns.kinds);
  put_column(out, columns.cubes);
  put_column(out, columns.log_odds);
  for (const auto* masks : {&columns.sampled, &columns.coloured}) put_column(out, *masks);
  for (const auto* values : {&columns.distances, &columns.weights}) put_column(out, *values);
  for (const auto* channel : {&columns.red, &columns.green, &columns.blue}) put_column(out, *channel);
  return out;
}

/// A leaf block at a depth, its first cell with a sample and a colour.
Columns leaf_block_at(std::size_t depth) {
  Columns columns;
  columns.kinds.assign(depth, 2);
  columns.kinds.push_back(3);
  columns.cubes.clear();
  columns.log_odds = {5, 0, 0, 0, 0, 0, 0, 0};
  columns.sampled = {1};
  columns.coloured = {1};
  columns.distances = {8};
  columns.weights = {2};
  columns.red = columns.green = columns.blue = {1};
  return columns;
}

TEST_F(OctreeFile, InvalidBlocksAreNamed) {
  const auto expect_fault = [&](const Columns& columns, const char* fault) {
    const std::string message = message_for_body(body_of(columns));
    EXPECT_NE(message.find(fault), std::string::npos) << message;
    EXPECT_EQ(message.find(path_.string() + ": "), 0U) << message;
    EXPECT_NE(message.find("make the map again"), std::string::npos) << message;
  };
  EXPECT_EQ(message_for_body(body_of({})), "");
  EXPECT_EQ(message_for_body(body_of(leaf_block_at(15))), "");
  EXPECT_EQ(message_for_body(body_of(leaf_block_at(14))), "");

  expect_fault({.resolution_m = 9.0}, "resolution");
  expect_fault({.log_odds_step = 0.0F}, "step");
  expect_fault({.kinds = {}, .cubes = {}}, "invalid");
  expect_fault({.kinds = {7}}, "invalid");
  expect_fault({.kinds = std::vector<std::uint16_t>(100'000, 0xAAAA)}, "invalid");  // deeper than voxels
  expect_fault({.kinds = {1}}, "invalid");        // all of the octree is free
  expect_fault({.kinds = {2, 2, 1}}, "invalid");  // 16,384 voxels of free space
  expect_fault({.cubes = {}}, "invalid");
  expect_fault({.cubes = {-100, -100}}, "invalid");  // one more than the nodes take
  expect_fault({.cubes = {0}}, "invalid");
  expect_fault(leaf_block_at(13), "invalid");
  expect_fault(leaf_block_at(16), "invalid");
  Columns columns = leaf_block_at(14);
  columns.sampled = columns.coloured = {0};
  columns.distances = columns.weights = {};
  columns.red = columns.green = columns.blue = {};
  expect_fault(columns, "invalid");  // a coarse block without a sample
  columns = leaf_block_at(15);
  columns.weights = {0};
  expect_fault(columns, "invalid");
  columns = leaf_block_at(15);
  columns.coloured = {2};
  expect_fault(columns, "invalid");  // a colour without a sample
  columns = leaf_block_at(15);
  columns.weights = {2, 2};
  expect_fault(columns, "2 weights, where 1 belong");
  columns = leaf_block_at(15);
  columns.log_odds.push_back(1);
  expect_fault(columns, "invalid");
  EXPECT_NE(message_for_body(body_of({}) + "x").find("1 bytes more"), std::string::npos);
}

TEST_F(OctreeFile, SizesAreCheckedBeforeMemoryIsTaken) {
  std::string body = body_of({});
  const std::uint64_t vast = std::uint64_t{1} << 40U;
  std::memcpy(body.data() + 20, &vast, sizeof(vast));  // the number of kinds
  EXPECT_NE(message_for_body(body).find("more than a file of this size can hold"), std::string::npos);
  const std::uint64_t too_many = 100;
  std::memcpy(body.data() + 20, &too_many, sizeof(too_many));
  EXPECT_NE(message_for_body(body).find("cannot be unpacked"), std::string::npos);
  // Zeros compress so well that a small file could fill any memory.
  const Columns zeros{.kinds = std::vector<std::uint16_t>(50'000'000)};
  EXPECT_NE(message_for_body(body_of(zeros)).find("more than a file of this size can hold"),
            std::string::npos);
}

TEST_F(OctreeFile, RandomDamageNeverCrashes) {
  StaticMap small(0.1);
  fuse_from(small, 0.05, 1);
  small.write(path_);
  std::string good = read_bytes(path_, "an octree");
  good = good.substr(12, good.size() - 20);  // without magic word, version and checksum
  std::mt19937 random(7);
  int refused = 0;
  for (int round = 0; round < 1'000; ++round) {
    std::string bad = good;
    for (int i = 0; i < 2; ++i) bad[random() % bad.size()] = static_cast<char>(random());
    refused += message_for_body(bad).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 100);
}

}  // namespace
}  // namespace roomradar::octree_file_test
