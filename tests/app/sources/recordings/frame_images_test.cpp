// frame_images_test.cpp: the images of a frame come back to the bit, and damage is named.
#include "app/sources/recordings/frame_images.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/temporary_folder.hpp"

namespace roomradar {
namespace {

/// Images with every extreme: noise, the lowest and highest values side by side, invalid and denormal depth.
Frame noisy_frame(int width, int height) {
  Frame frame;
  frame.depth_m = DepthImage(width, height, 0.0F);
  frame.colour = ColourImage(width, height);
  std::minstd_rand random(7);
  const auto byte = [&] {
    return static_cast<std::uint8_t>(random() % 3 == 0 ? 255 * (random() % 2) : random());
  };
  for (float& depth_m : frame.depth_m.pixels)
    depth_m = random() % 4 == 0 ? 0.0F : static_cast<float>(random() % 10000) / 1234.0F;
  for (Rgb& pixel : frame.colour.pixels) pixel = {byte(), byte(), byte()};
  frame.depth_m.pixels.front() = std::numeric_limits<float>::denorm_min();
  frame.depth_m.pixels.back() = std::numeric_limits<float>::max();
  return frame;
}

TEST(FrameImages, ComeBackToTheBit) {
  const test::TemporaryFolder folder;
  Frame again;
  for (const auto [width, height] : {std::array{640, 480}, {33, 7}, {1, 1}, {1, 5}}) {
    const Frame frame = noisy_frame(width, height);
    write_frame_images(frame, folder.path() / "a.images");
    read_frame_images(folder.path() / "a.images", again);
    EXPECT_EQ(again.depth_m.width, width);
    EXPECT_EQ(again.colour.height, height);
    EXPECT_EQ(again.depth_m.pixels, frame.depth_m.pixels);
    EXPECT_EQ(again.colour.pixels, frame.colour.pixels);
  }
}

TEST(FrameImages, OfDifferentSizesOrWithoutColour) {
  const test::TemporaryFolder folder;
  Frame frame = noisy_frame(16, 12), again = noisy_frame(4, 4);
  frame.colour = noisy_frame(8, 3).colour;
  write_frame_images(frame, folder.path() / "a.images");
  read_frame_images(folder.path() / "a.images", again);
  EXPECT_EQ(again.colour.width, 8);
  EXPECT_EQ(again.colour.pixels, frame.colour.pixels);
  frame.colour.resize(0, 0);
  write_frame_images(frame, folder.path() / "a.images");
  read_frame_images(folder.path() / "a.images", again);
  EXPECT_TRUE(again.colour.empty());
  EXPECT_EQ(again.depth_m.pixels, frame.depth_m.pixels);
}

TEST(FrameImages, DamageAnywhereIsNamed) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.images";
  write_frame_images(noisy_frame(16, 12), path);
  const std::string sound = read_bytes(path, "images");
  Frame frame;
  const auto fault = [&](const std::string& bytes) {
    write_bytes(path, bytes);
    return test::error_of([&] { read_frame_images(path, frame); });
  };
  for (std::size_t at = 0; at < sound.size(); ++at) {
    std::string altered = sound;
    altered[at] = static_cast<char>(altered[at] ^ 0x40);
    EXPECT_NE(fault(altered).find("a.images: is "), std::string::npos) << "byte " << at;
    EXPECT_NE(fault(sound.substr(0, at)).find("a.images: is "), std::string::npos) << at << " bytes";
  }
  EXPECT_NE(fault(sound + "x").find("has bytes after its end"), std::string::npos);
}

TEST(FrameImages, AHugeSizeTakesNoMemory) {
  const test::TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "a.images";
  write_frame_images(noisy_frame(4, 4), path);
  std::string bytes = read_bytes(path, "images");
  const std::array<std::int32_t, 2> size{16384, 16384};
  bytes.replace(8, sizeof size, reinterpret_cast<const char*>(size.data()), sizeof size);
  write_bytes(path, bytes);
  Frame frame;
  EXPECT_NE(test::error_of([&] { read_frame_images(path, frame); }).find("too short for its images"),
            std::string::npos);
  EXPECT_LT(frame.depth_m.pixels.capacity(), 1000U);
  Frame wide;
  wide.depth_m = DepthImage(16385, 1, 1.0F);
  EXPECT_NE(test::error_of([&] { write_frame_images(wide, path); }).find("16385 x 1 px is too large"),
            std::string::npos);
}

}  // namespace
}  // namespace roomradar
