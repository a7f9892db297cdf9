// jpeg_test.cpp: the pixels and bytes of OpenCV's codec, and faults of damaged files.
#include "mapping/types/codecs/jpeg.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>  // jpeglib.h uses it
#include <cstdlib>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include <jpeglib.h>

#include "mapping/types/system/error.hpp"
#include "tests/support/error_of.hpp"

namespace roomradar::jpeg_test {
namespace {

using test::error_of;

/// Waves of three colours, 61 x 47: no multiple of a JPEG's blocks.
cv::Mat waves() {
  cv::Mat image(47, 61, CV_8UC3);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      for (int c = 0; c < 3; ++c)
        image.at<cv::Vec3b>(y, x)[c] =
            static_cast<unsigned char>(128.0 + 100.0 * std::sin(0.1 * (c + 1) * x + 0.2 * y));
  return image;
}

std::string opencvs_jpeg(const cv::Mat& image, const std::vector<int>& parameters) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

void expect_opencvs_pixels(const std::string& jpeg) {
  const cv::Mat bytes(1, static_cast<int>(jpeg.size()), CV_8UC1, const_cast<char*>(jpeg.data()));
  const cv::Mat expected = cv::imdecode(bytes, cv::IMREAD_COLOR);
  ColourImage colour;
  ASSERT_EQ(decode_jpeg(jpeg, colour), std::nullopt);
  ASSERT_EQ(colour.width, expected.cols);
  ASSERT_EQ(colour.height, expected.rows);
  for (int y = 0; y < expected.rows; ++y)
    for (int x = 0; x < expected.cols; ++x) {
      const cv::Vec3b& bgr = expected.at<cv::Vec3b>(y, x);
      ASSERT_EQ(colour.at(x, y), (Rgb{bgr[2], bgr[1], bgr[0]})) << x << ", " << y;
    }
}

TEST(Jpeg, PixelsAreThoseOfOpenCV) {
  expect_opencvs_pixels(opencvs_jpeg(waves(), {cv::IMWRITE_JPEG_QUALITY, 90}));
  expect_opencvs_pixels(
      opencvs_jpeg(waves(), {cv::IMWRITE_JPEG_QUALITY, 40, cv::IMWRITE_JPEG_PROGRESSIVE, 1}));
}

TEST(Jpeg, AGreyImageBecomesGreyColours) {
  cv::Mat grey;
  cv::cvtColor(waves(), grey, cv::COLOR_BGR2GRAY);
  expect_opencvs_pixels(opencvs_jpeg(grey, {}));
}

TEST(Jpeg, CmykBecomesTheColoursOfOpenCV) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = info.image_height = 20;
  info.input_components = 4;
  info.in_color_space = JCS_CMYK;
  jpeg_set_defaults(&info);
  jpeg_start_compress(&info, TRUE);
  std::vector<JSAMPLE> row(80);
  for (int y = 0; y < 20; ++y) {
    for (std::size_t i = 0; i < row.size(); ++i) row[i] = static_cast<JSAMPLE>(255 - 10 * y - i % 4 * 12);
    JSAMPROW rows = row.data();
    jpeg_write_scanlines(&info, &rows, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  const std::string jpeg(bytes, bytes + size);
  std::free(bytes);
  expect_opencvs_pixels(jpeg);
}

TEST(Jpeg, BytesAreThoseOfOpenCV) {
  const cv::Mat bgr = waves();
  ColourImage picture(bgr.cols, bgr.rows);
  for (int y = 0; y < bgr.rows; ++y)
    for (int x = 0; x < bgr.cols; ++x) {
      const cv::Vec3b& pixel = bgr.at<cv::Vec3b>(y, x);
      picture.at(x, y) = {pixel[2], pixel[1], pixel[0]};
    }
  const std::vector<std::uint8_t> jpeg = jpeg_of(picture, 90);
  EXPECT_EQ(std::string(jpeg.begin(), jpeg.end()),
            opencvs_jpeg(bgr, {cv::IMWRITE_JPEG_QUALITY, 90, cv::IMWRITE_JPEG_OPTIMIZE, 1}));
  EXPECT_THROW((void)jpeg_of({}, 90), Error);
}

TEST(Jpeg, FaultsAreReturned) {
  const std::string jpeg = opencvs_jpeg(waves(), {});
  ColourImage colour(61, 47);
  EXPECT_TRUE(decode_jpeg("", colour));
  EXPECT_TRUE(decode_jpeg("this is no JPEG", colour));
  EXPECT_TRUE(decode_jpeg(jpeg.substr(0, 30), colour)) << "ends before the pixels begin";
  std::string wide = jpeg;  // the frame's header: marker, length, precision, height, width
  const std::size_t frame = wide.find("\xff\xc0");
  ASSERT_NE(frame, std::string::npos);
  wide[frame + 7] = '\x40';
  wide[frame + 8] = '\x01';
  EXPECT_EQ(decode_jpeg(wide, colour), "it has more than 16384 px per side");
}

TEST(Jpeg, NoAlteredByteDoesHarm) {
  const std::string jpeg = opencvs_jpeg(waves(), {});
  ColourImage colour(61, 47);
  for (std::size_t i = 0; i < jpeg.size(); ++i)
    for (const char value : {'\0', '\xff', static_cast<char>(jpeg[i] ^ 0x11)}) {
      std::string altered = jpeg;
      altered[i] = value;
      (void)decode_jpeg(altered, colour);  // under a sanitizer: no access outside the image
    }
  EXPECT_EQ(colour.pixels.size(), std::size_t{61 * 47});
}

TEST(Jpeg, DamagedBytesOfATextureAreNotACrash) {
  const std::vector<std::uint8_t> jpeg = jpeg_of(ColourImage(64, 64, {10, 200, 30}), 90);
  const ColourImage whole = picture_of_jpeg(jpeg, 64, 64, "a.jpg");
  EXPECT_NEAR(whole.at(30, 30).g, 200, 4);
  EXPECT_NE(error_of([&] { (void)picture_of_jpeg(jpeg, 64, 63, "a.jpg"); }).find("a.jpg: has 64 x 64"),
            std::string::npos);
  EXPECT_NE(error_of([&] { (void)picture_of_jpeg({}, 64, 64, "a.jpg"); }).find("is not a JPEG"),
            std::string::npos);
  for (std::size_t i = 2; i + 2 < jpeg.size(); ++i) {
    std::vector<std::uint8_t> damaged = jpeg;
    damaged[i] ^= 0x5a;
    try {
      EXPECT_EQ(picture_of_jpeg(damaged, 64, 64, "a.jpg").width, 64);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("a.jpg"), std::string::npos);
    }
  }
}

}  // namespace
}  // namespace roomradar::jpeg_test
