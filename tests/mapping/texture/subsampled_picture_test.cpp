// subsampled_picture_test.cpp: colours come back, brightness at full resolution, whatever the picture's size.
#include "mapping/texture/subsampled_picture.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace roomradar::subsampled_picture_test {
namespace {

double difference(const Eigen::Array3f& colour, const Rgb& expected) {
  return (colour - Eigen::Array3f(expected.r, expected.g, expected.b)).abs().maxCoeff();
}

/// Every colour of a coarse grid over RGB, with the corners of the cube.
std::vector<Rgb> colours() {
  std::vector<Rgb> all;
  for (int r = 0; r <= 255; r += 51)
    for (int g = 0; g <= 255; g += 51)
      for (int b = 0; b <= 255; b += 51)
        all.push_back(
            {static_cast<std::uint8_t>(r), static_cast<std::uint8_t>(g), static_cast<std::uint8_t>(b)});
  return all;
}

TEST(SubsampledPicture, AUniformPictureKeepsItsColour) {
  for (const Rgb& colour : colours()) {
    const SubsampledPicture picture = subsampled(ColourImage(4, 4, colour));
    EXPECT_LE(difference(colour_at(picture, {1.3F, 2.6F}), colour), 1.5);
    EXPECT_LE(difference(mean_colour(picture, 2, 2, 2), colour), 1.5);
  }
}

TEST(SubsampledPicture, BrightnessKeepsItsResolution) {
  ColourImage stripes(8, 6);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) stripes.at(x, y) = x % 2 == 0 ? Rgb{200, 200, 200} : Rgb{40, 40, 40};
  const SubsampledPicture picture = subsampled(stripes);
  for (int x = 0; x < 8; ++x)
    EXPECT_LE(difference(colour_at(picture, {static_cast<float>(x), 3.0F}), stripes.at(x, 3)), 1.0) << x;
  EXPECT_LE(difference(colour_at(picture, {2.5F, 3.0F}), {120, 120, 120}), 1.0);
}

TEST(SubsampledPicture, ChromaIsInterpolatedBetweenTheMiddlesOfItsBlocks) {
  // Of equal brightness: left half red, right half green.
  const Rgb red{180, 60, 60}, green{60, 121, 60};
  ColourImage halves(8, 2);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 8; ++x) halves.at(x, y) = x < 4 ? red : green;
  const SubsampledPicture picture = subsampled(halves);
  EXPECT_LE(difference(colour_at(picture, {2.5F, 0.0F}), red), 1.5);
  EXPECT_LE(difference(colour_at(picture, {4.5F, 0.0F}), green), 1.5);
  EXPECT_LE(difference(colour_at(picture, {3.5F, 0.0F}), {120, 91, 60}), 2.0);
}

TEST(SubsampledPicture, OddSizesSinglePixelsAndCoordinatesOutside) {
  const Rgb colour{30, 90, 200};
  for (const int width : {1, 2, 3, 5})
    for (const int height : {1, 2, 3, 5}) {
      const SubsampledPicture picture = subsampled(ColourImage(width, height, colour));
      for (const float at : {-1e6F, -1.0F, 0.0F, 4.7F, 1e6F})
        EXPECT_LE(difference(colour_at(picture, {at, at}), colour), 1.5) << width << " x " << height;
    }
  EXPECT_TRUE(subsampled(ColourImage()).luma.empty());
}

TEST(SubsampledPicture, TakesOneAndAHalfBytesPerPixel) {
  const SubsampledPicture picture = subsampled(ColourImage(640, 480));
  EXPECT_EQ(picture.luma.pixels.size() + sizeof(SubsampledPicture::Chroma) * picture.chroma.pixels.size(),
            std::size_t{640 * 480 * 3 / 2});
}

}  // namespace
}  // namespace roomradar::subsampled_picture_test
