// rvl_depth_test.cpp: RVL against an encoder that follows RTAB-Map's, known bytes, damaged streams.
#include "app/sources/containers/rvl_depth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "mapping/types/system/error.hpp"
#include "tests/app/sources/containers/written_rvl.hpp"
#include "tests/app/sources/sources_support.hpp"

namespace roomradar::rvl_depth_test {
namespace {

using test::contains;
using test::error_of;
using test::little_endian;
using test::written_rvl;

Image<std::uint16_t> decoded(const std::string& bytes, RvlSize expected = {}) {
  Image<std::uint16_t> image;
  decode_rvl(bytes, expected, "depth", image);
  return image;
}

std::string fault_of(const std::string& bytes, RvlSize expected = {}) {
  return error_of([&] { (void)decoded(bytes, expected); });
}

/// Runs of zeros, of smooth depth and of noise over all 16 bits.
Image<std::uint16_t> random_image(int width_px, int height_px, std::mt19937& random) {
  Image<std::uint16_t> image(width_px, height_px);
  const auto below = [&random](unsigned n) { return static_cast<unsigned>(random() % n); };
  unsigned left = 0, kind = 0, value = 1000;
  for (std::uint16_t& pixel : image.pixels) {
    if (left == 0) {
      left = 1 + below(40);
      kind = below(3);
    }
    --left;
    if (kind == 1) value = std::clamp(value + below(9), 5U, 65000U) - 4;
    if (kind == 2) value = 1 + below(65535);
    pixel = static_cast<std::uint16_t>(kind == 0 ? 0 : value);
  }
  return image;
}

// 0 5 6 0: one zero, two others, +5 and +1 as 10 (groups 2 and 1) and 2, one zero, no others.
TEST(RvlDepth, DecodesKnownBytes) {
  const std::string stream("\x00\x21\xA1\x12", 4);
  const std::string bytes = little_endian(4) + little_endian(1) + stream;
  const Image<std::uint16_t> image = decoded(bytes);
  EXPECT_EQ(image.width, 4);
  EXPECT_EQ(image.height, 1);
  EXPECT_EQ(image.pixels, (std::vector<std::uint16_t>{0, 5, 6, 0}));
  EXPECT_EQ(written_rvl(image), bytes);
  EXPECT_EQ(decoded(bytes + "more").pixels, image.pixels) << "as a blob that is longer than its image";
  EXPECT_EQ(decoded(bytes, {4, 1}).pixels, image.pixels);
}

TEST(RvlDepth, GivesWhatWasWritten) {
  std::mt19937 random(7);
  for (int i = 0; i < 200; ++i) {
    const auto image =
        random_image(1 + static_cast<int>(random() % 70), 1 + static_cast<int>(random() % 50), random);
    ASSERT_EQ(decoded(written_rvl(image)).pixels, image.pixels) << "image " << i;
  }
  const Image<std::uint16_t> black(640, 480), far(640, 480, 65535);
  EXPECT_EQ(decoded(written_rvl(black)).pixels, black.pixels) << "a covered lens: 12 bytes";
  EXPECT_EQ(decoded(written_rvl(far)).pixels, far.pixels);
}

TEST(RvlDepth, RejectsEachTruncatedStream) {
  std::mt19937 random(3);
  const std::string whole = written_rvl(random_image(30, 20, random));
  for (std::size_t length = 0; length < whole.size(); ++length)
    EXPECT_TRUE(contains(fault_of(whole.substr(0, length)), "depth: is cut short")) << length;
}

TEST(RvlDepth, RejectsAbsurdSizesBeforeItAllocates) {
  const std::string zeros(40, '\0');
  const auto size = [&](std::uint32_t columns, std::uint32_t rows) {
    return fault_of(little_endian(columns) + little_endian(rows) + zeros);
  };
  EXPECT_TRUE(contains(size(0, 480), "its size of 0 x 480 is not in 1..16384"));
  EXPECT_TRUE(contains(size(640, 0), "is not in 1..16384"));
  EXPECT_TRUE(contains(size(16385, 1), "is not in 1..16384"));
  EXPECT_TRUE(contains(size(0xFFFFFFFF, 0xFFFFFFFF), "is not in 1..16384"));
  EXPECT_TRUE(contains(size(16384, 16384), "is damaged: 40 bytes for an image of 16384 x 16384"));
  EXPECT_TRUE(contains(fault_of(written_rvl(Image<std::uint16_t>(64, 48)), {640, 480}),
                       "depth: is 64 x 48; the recording's other depth images are 640 x 480"));
}

TEST(RvlDepth, RejectsImpossibleRunsAndPixels) {
  const std::string size = little_endian(4) + little_endian(1);
  EXPECT_TRUE(contains(fault_of(size + little_endian(0x50000000)), "a run passes the end of the image"));
  EXPECT_TRUE(contains(fault_of(size + little_endian(0x05220000)), "a run passes the end of the image"));
  EXPECT_TRUE(contains(fault_of(size + little_endian(0x01100000)), "a pixel is outside 1..65535")) << "-1";
  EXPECT_TRUE(contains(fault_of(size + little_endian(0xFFFFFFFF) + little_endian(0xFFFFFFFF)),
                       "a number has too many bits"));
}

}  // namespace
}  // namespace roomradar::rvl_depth_test
