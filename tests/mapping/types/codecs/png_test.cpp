// png_test.cpp: the pixels of OpenCV's codec for every type of PNG, and faults of damaged files.
#include "mapping/types/codecs/png.hpp"

#include <gtest/gtest.h>
#include <png.h>
#include <zlib.h>

#include <array>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "mapping/types/system/error.hpp"

namespace roomradar::png_test {
namespace {

constexpr int kWidth = 37, kHeight = 19;

/// An image of the OpenCV type, whose bytes all differ from their neighbours'.
cv::Mat mixed(int type) {
  cv::Mat image(kHeight, kWidth, type);
  for (std::size_t i = 0; i < image.total() * image.elemSize(); ++i)
    image.data[i] = static_cast<unsigned char>(i * 97 + i / 256 * 31);
  return image;
}

std::string text_of(const std::vector<unsigned char>& bytes) { return {bytes.begin(), bytes.end()}; }

std::string opencvs_png(const cv::Mat& image, const std::vector<int>& parameters = {}) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes, parameters);
  return text_of(bytes);
}

cv::Mat opencvs_pixels(const std::string& png, int flags) {
  return cv::imdecode(cv::Mat(1, static_cast<int>(png.size()), CV_8UC1, const_cast<char*>(png.data())),
                      flags);
}

/// An interlaced palette PNG of 4 bits with one transparent colour, which OpenCV cannot write.
std::string palette_png() {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp writer, png_bytep from, png_size_t count) {
        static_cast<std::string*>(png_get_io_ptr(writer))->append(reinterpret_cast<char*>(from), count);
      },
      nullptr);
  std::array<png_color, 16> colours{};
  for (int i = 0; i < 16; ++i)
    colours[static_cast<std::size_t>(i)] = {static_cast<png_byte>(17 * i), static_cast<png_byte>(255 - 9 * i),
                                            static_cast<png_byte>(i * i)};
  const std::array<png_byte, 3> opacity{255, 40, 0};
  png_set_IHDR(png, info, kWidth, kHeight, 4, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_ADAM7,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_PLTE(png, info, colours.data(), 16);
  png_set_tRNS(png, info, opacity.data(), 3, nullptr);
  std::vector<png_byte> pixels((kWidth + 1) / 2 * kHeight);
  std::vector<png_bytep> rows;
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<png_byte>(i * 29);
  for (std::size_t y = 0; y < kHeight; ++y) rows.push_back(pixels.data() + y * ((kWidth + 1) / 2));
  png_set_rows(png, info, rows.data());
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

/// Returns a pixel of OpenCV's image as 8 bit red, green, blue and alpha.
Rgba rgba_at(const cv::Mat& image, int x, int y) {
  const int channels = image.channels();
  const auto at = [&](int c) {
    const int index = x * channels + c;
    return image.depth() == CV_16U ? static_cast<std::uint8_t>(image.ptr<std::uint16_t>(y)[index] >> 8)
                                   : image.ptr<std::uint8_t>(y)[index];
  };
  if (channels == 1) return {at(0), at(0), at(0), 255};
  return {at(2), at(1), at(0), channels == 4 ? at(3) : std::uint8_t{255}};
}

void expect_opencvs_pixels(const std::string& png, const std::string& what) {
  const cv::Mat unchanged = opencvs_pixels(png, cv::IMREAD_UNCHANGED);
  const cv::Mat colour = opencvs_pixels(png, cv::IMREAD_COLOR);
  Image<Rgba> rgba;
  ColourImage rgb(kWidth, kHeight, {1, 2, 3});
  ASSERT_EQ(decode_png(png, rgba), std::nullopt) << what;
  ASSERT_EQ(decode_png(png, rgb), std::nullopt) << what;
  ASSERT_EQ(rgba.width, unchanged.cols) << what;
  ASSERT_EQ(rgba.height, unchanged.rows) << what;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_EQ(rgba.at(x, y), rgba_at(unchanged, x, y)) << what << " " << x << ", " << y;
      const Rgba opaque = rgba_at(colour, x, y);
      ASSERT_EQ(rgb.at(x, y), (Rgb{opaque.r, opaque.g, opaque.b})) << what << " " << x << ", " << y;
    }
}

TEST(Png, PixelsAreThoseOfOpenCV) {
  for (const int type : {CV_8UC1, CV_8UC3, CV_8UC4, CV_16UC1, CV_16UC3, CV_16UC4})
    expect_opencvs_pixels(opencvs_png(mixed(type)), cv::typeToString(type));
  expect_opencvs_pixels(opencvs_png(mixed(CV_8UC1) > 100, {cv::IMWRITE_PNG_BILEVEL, 1}), "one bit");
  expect_opencvs_pixels(palette_png(), "palette, interlaced");
}

TEST(Png, GreyOfEightAndSixteenBitsIsExact) {
  const cv::Mat eight = mixed(CV_8UC1), sixteen = mixed(CV_16UC1);
  Image<std::uint8_t> grey8;
  Image<std::uint16_t> grey16;
  ASSERT_EQ(decode_png(opencvs_png(eight), grey8), std::nullopt);
  ASSERT_EQ(decode_png(opencvs_png(sixteen), grey16), std::nullopt);
  EXPECT_TRUE(std::equal(grey8.pixels.begin(), grey8.pixels.end(), eight.data));
  EXPECT_TRUE(std::equal(grey16.pixels.begin(), grey16.pixels.end(), sixteen.ptr<std::uint16_t>()));
  EXPECT_EQ(decode_png(opencvs_png(eight), grey16), "it is not a 16-bit grey PNG");
  EXPECT_EQ(decode_png(opencvs_png(sixteen), grey8), "it is not an 8-bit grey PNG");
  EXPECT_EQ(decode_png(opencvs_png(mixed(CV_8UC3)), grey8), "it is not an 8-bit grey PNG");
}

TEST(Png, OpenCVReadsWhatIsWritten) {
  for (const PngEffort effort : {PngEffort::kFast, PngEffort::kSmall}) {
    ColourImage colour(kWidth, kHeight);
    Image<std::uint8_t> grey8(kWidth, kHeight);
    Image<std::uint16_t> grey16(kWidth, kHeight);
    for (std::size_t i = 0; i < colour.pixels.size(); ++i) {
      const auto value = static_cast<std::uint8_t>(i * 41);
      colour.pixels[i] = {value, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i / 3)};
      grey8.pixels[i] = value;
      grey16.pixels[i] = static_cast<std::uint16_t>(i * 1021);
    }
    const cv::Mat bgr = opencvs_pixels(text_of(encode_png(colour, effort)), cv::IMREAD_UNCHANGED);
    const cv::Mat eight = opencvs_pixels(text_of(encode_png(grey8, effort)), cv::IMREAD_UNCHANGED);
    const cv::Mat sixteen = opencvs_pixels(text_of(encode_png(grey16, effort)), cv::IMREAD_UNCHANGED);
    ASSERT_EQ(bgr.type(), CV_8UC3);
    ASSERT_EQ(eight.type(), CV_8UC1);
    ASSERT_EQ(sixteen.type(), CV_16UC1);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x) {
        const Rgba pixel = rgba_at(bgr, x, y);
        ASSERT_EQ(colour.at(x, y), (Rgb{pixel.r, pixel.g, pixel.b}));
        ASSERT_EQ(grey8.at(x, y), eight.at<std::uint8_t>(y, x));
        ASSERT_EQ(grey16.at(x, y), sixteen.at<std::uint16_t>(y, x));
      }
  }
  EXPECT_THROW((void)encode_png(ColourImage()), Error);
  EXPECT_THROW((void)encode_png(ColourImage(16385, 1)), Error);
}

/// Writes width and height into the header, with the right checksum.
std::string with_size(std::string png, std::uint32_t width, std::uint32_t height) {
  const auto put = [&](std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) png[at + i] = static_cast<char>(value >> (24 - 8 * i));
  };
  put(16, width);
  put(20, height);
  put(29, static_cast<std::uint32_t>(crc32(0, reinterpret_cast<const Bytef*>(png.data()) + 12, 17)));
  return png;
}

TEST(Png, ADamagedFileIsAFault) {
  const std::string png = opencvs_png(mixed(CV_16UC1));
  Image<std::uint16_t> image;
  for (std::size_t size = 0; size < png.size(); ++size)
    ASSERT_TRUE(decode_png(png.substr(0, size), image)) << size << " bytes";
  std::string altered = png;
  altered[png.size() / 2] ^= 0x11;
  EXPECT_TRUE(decode_png(altered, image)) << "the checksum";
  EXPECT_TRUE(decode_png("this is no PNG, and says so", image));
}

TEST(Png, SizesAreBoundedBeforeMemoryIsAllocated) {
  const std::string png = opencvs_png(mixed(CV_16UC1));
  Image<std::uint16_t> image;
  EXPECT_EQ(decode_png(with_size(png, 16384, 16384), image), "it is too short for its size");
  EXPECT_TRUE(image.empty());
  EXPECT_TRUE(decode_png(with_size(png, 16385, 1), image));
  EXPECT_TRUE(decode_png(with_size(png, 1, 0), image));
  EXPECT_TRUE(decode_png(with_size(png, kWidth, kHeight + 1), image)) << "a row is missing";
  EXPECT_EQ(decode_png(with_size(png, kWidth, kHeight), image), std::nullopt);
}

TEST(Png, NoAlteredByteDoesHarm) {
  const std::string png = palette_png();
  Image<Rgba> image;
  for (std::size_t i = 0; i < png.size(); ++i)
    for (const char value : {'\0', '\xff', static_cast<char>(png[i] ^ 0x11)}) {
      std::string altered = png;
      altered[i] = value;
      (void)decode_png(altered, image);  // under a sanitizer: no access outside the image
    }
  EXPECT_EQ(decode_png(png, image), std::nullopt);
}

}  // namespace
}  // namespace roomradar::png_test
