// binary_recordings_test.cpp: ScanNet's .sens and ElasticFusion's .klg, written by their published formats.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <limits>
#include <opencv2/imgcodecs.hpp>

#include "app/sources/recordings/folder_source.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::binary_recordings_test {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using test::contains;
using test::error_of;
using test::read_all;
using test::TemporaryFolder;
using test::write_text;

std::string depth_bytes(int width_px, int height_px, int first_mm) {
  std::string bytes;
  for (int p = 0; p < width_px * height_px; ++p)
    bytes += bytes_of(static_cast<std::uint16_t>(p == 0 ? 0 : first_mm + p));
  return bytes;
}

std::string zlib(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string packed(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(packed.data()), &size,
                     reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  packed.resize(size);
  return packed;
}

std::string jpeg(int width_px, int height_px) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", cv::Mat(height_px, width_px, CV_8UC3, cv::Scalar(9, 99, 199)), bytes);
  return {bytes.begin(), bytes.end()};
}

std::string matrix(float fx, float cx, float fy, float cy, float x = 0.0F) {
  const float m[16] = {fx, 0, cx, x, 0, fy, cy, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  return {reinterpret_cast<const char*>(m), sizeof m};
}

constexpr int kWidth = 8, kHeight = 6;

std::string sens(std::int32_t depth_kind, bool with_stamps) {
  const std::string name = "StructureSensor";
  std::string bytes = bytes_of(std::uint32_t{4}) + bytes_of(std::uint64_t{name.size()}) + name;
  bytes += matrix(30, 15, 31, 11) + matrix(1, 0, 1, 0) + matrix(10, 4, 11, 3) + matrix(1, 0, 1, 0, 0.02F);
  bytes += bytes_of(std::int32_t{2}) + bytes_of(depth_kind);
  for (const std::uint32_t size : {32U, 24U, 8U, 6U}) bytes += bytes_of(size);
  bytes += bytes_of(1000.0F) + bytes_of(std::uint64_t{3});
  for (int i = 0; i < 3; ++i) {
    const float lost = -std::numeric_limits<float>::infinity();
    bytes += i == 1 ? matrix(lost, lost, lost, lost) : matrix(1, 0, 1, 0, static_cast<float>(i));
    const std::string colour = jpeg(32, 24), raw = depth_bytes(kWidth, kHeight, 1000 + i);
    const std::string depth = depth_kind == 1 ? zlib(raw) : raw;
    const std::uint64_t stamp_us = with_stamps ? 5'000'000U + 40'000U * static_cast<std::uint64_t>(i) : 0;
    bytes += bytes_of(stamp_us) + bytes_of(stamp_us) + bytes_of(std::uint64_t{colour.size()}) +
             bytes_of(std::uint64_t{depth.size()}) + colour + depth;
  }
  return bytes + bytes_of(std::uint64_t{0});  // no IMU
}

TEST(ScanNetSens, GivesDepthColourCamerasAndPoses) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "scene.sens";
  for (const std::int32_t depth_kind : {0, 1}) {
    write_text(path, sens(depth_kind, true));
    const auto all = read_all(*open_folder(path));
    ASSERT_EQ(all.frames.size(), 3U) << (all.faults.empty() ? "" : all.faults[0]);
    const Frame& frame = all.frames[2];
    EXPECT_EQ(frame.depth_m.at(0, 0), 0.0F);
    EXPECT_EQ(frame.depth_m.at(3, 1), 1.013F);
    EXPECT_EQ(frame.depth_camera, (Intrinsics{8, 6, 10, 11, 4, 3}));
    EXPECT_EQ(frame.colour_camera, (Intrinsics{32, 24, 30, 31, 15, 11}));
    EXPECT_NEAR(frame.colour.at(5, 5).r, 199, 3);
    EXPECT_NEAR(frame.T_colour_depth.translation().x(), 0.02, 1e-7);
    EXPECT_NEAR(frame.T_world_camera->translation().x(), 2.0, 1e-9);
    EXPECT_FALSE(all.frames[1].T_world_camera) << "tracking was lost";
    EXPECT_NEAR(frame.stamp_s, 5.08, 1e-9);
  }
  write_text(path, sens(1, false));
  EXPECT_NEAR(read_all(*open_folder(path)).frames[2].stamp_s, 2 / 30.0, 1e-9);
}

TEST(ScanNetSens, ReadsWhatIsLeftAndSaysWhatIsWrong) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "scene.sens";
  const std::string whole = sens(1, true);
  write_text(path, whole.substr(0, whole.size() - 20));
  EXPECT_EQ(read_all(*open_folder(path)).frames.size(), 2U);
  for (std::size_t size = 4; size < 500; size += 7) {
    write_text(path, whole.substr(0, size));
    EXPECT_GT(error_of([&] { (void)open_folder(path); }).size(), 10U) << size;
  }
  write_text(path, sens(2, true));
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(path); }),
                       "depth compression is not supported; must be raw or zlib"));
  std::string large = whole;
  large.replace(12 + 15 + 4 * 64 + 8 + 8, 4, bytes_of(std::uint32_t{100'000}));  // depth's width
  write_text(path, large);
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(path); }), "not in 1..16384"));
}

TEST(Klg, GivesDepthAndColour) {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "walk.klg";
  std::string bytes = bytes_of(std::int32_t{3});
  for (int i = 0; i < 3; ++i) {
    const std::string raw = depth_bytes(64, 48, 2000 + i), depth = i == 1 ? raw : zlib(raw);
    const std::string colour = i == 2 ? "" : jpeg(64, 48);
    bytes += bytes_of(std::int64_t{1'000'000 + 33'000 * i}) +
             bytes_of(static_cast<std::int32_t>(depth.size())) +
             bytes_of(static_cast<std::int32_t>(colour.size())) + depth + colour;
  }
  write_text(path, bytes);
  const auto all = read_all(*open_folder(path));
  ASSERT_EQ(all.frames.size(), 3U) << (all.faults.empty() ? "" : all.faults[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(all.frames[i].depth_m.at(7, 0), 2.007 + 0.001 * static_cast<double>(i), 1e-6);
    EXPECT_NEAR(all.frames[i].stamp_s, 1.0 + 0.033 * static_cast<double>(i), 1e-9);
    EXPECT_EQ(all.frames[i].colour.empty(), i == 2);
  }
  EXPECT_NEAR(all.frames[0].depth_camera.fx_px, 52.8, 1e-9);
  EXPECT_NEAR(all.frames[0].colour.at(5, 5).r, 199, 3);

  write_text(path, bytes.substr(0, bytes.size() - 2));
  EXPECT_EQ(read_all(*open_folder(path)).frames.size(), 2U);
  write_text(path, bytes_of(std::int32_t{-1}));
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(path); }), "states -1 frames"));
  write_text(path, bytes_of(std::int32_t{1}) + bytes_of(std::int64_t{0}) + bytes_of(std::int32_t{-5}) +
                       bytes_of(std::int32_t{0}));
  EXPECT_TRUE(contains(error_of([&] { (void)open_folder(path); }), "size below 0"));
}

}  // namespace
}  // namespace roomradar::binary_recordings_test
