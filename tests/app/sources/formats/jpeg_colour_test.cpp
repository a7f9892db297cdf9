// jpeg_colour_test.cpp: the pixels of OpenCV's decoder, and faults of damaged files.
#include "app/sources/formats/jpeg_colour.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

namespace roomradar::jpeg_colour_test {
namespace {

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

std::string jpeg_of(const cv::Mat& image, const std::vector<int>& parameters) {
  std::vector<unsigned char> bytes;
  cv::imencode(".jpg", image, bytes, parameters);
  return {bytes.begin(), bytes.end()};
}

void expect_opencvs_pixels(const std::string& jpeg) {
  const cv::Mat bytes(1, static_cast<int>(jpeg.size()), CV_8UC1, const_cast<char*>(jpeg.data()));
  const cv::Mat expected = cv::imdecode(bytes, cv::IMREAD_COLOR);
  ColourImage colour(expected.cols, expected.rows);
  ASSERT_EQ(decode_jpeg(jpeg, colour), std::nullopt);
  for (int y = 0; y < expected.rows; ++y)
    for (int x = 0; x < expected.cols; ++x) {
      const cv::Vec3b& bgr = expected.at<cv::Vec3b>(y, x);
      ASSERT_EQ(colour.at(x, y), (Rgb{bgr[2], bgr[1], bgr[0]})) << x << ", " << y;
    }
}

TEST(JpegColour, PixelsAreThoseOfOpenCV) {
  expect_opencvs_pixels(jpeg_of(waves(), {cv::IMWRITE_JPEG_QUALITY, 90}));
  expect_opencvs_pixels(jpeg_of(waves(), {cv::IMWRITE_JPEG_QUALITY, 40, cv::IMWRITE_JPEG_PROGRESSIVE, 1}));
}

TEST(JpegColour, AGreyImageBecomesGreyColours) {
  cv::Mat grey;
  cv::cvtColor(waves(), grey, cv::COLOR_BGR2GRAY);
  expect_opencvs_pixels(jpeg_of(grey, {}));
}

TEST(JpegColour, FaultsAreReturned) {
  const std::string jpeg = jpeg_of(waves(), {});
  ColourImage colour(61, 47);
  EXPECT_TRUE(decode_jpeg("", colour));
  EXPECT_TRUE(decode_jpeg("this is no JPEG", colour));
  EXPECT_TRUE(decode_jpeg(jpeg.substr(0, 30), colour)) << "ends before the pixels begin";
  ColourImage other(60, 47);
  EXPECT_TRUE(decode_jpeg(jpeg, other)) << "of another size";
}

TEST(JpegColour, NoAlteredByteDoesHarm) {
  const std::string jpeg = jpeg_of(waves(), {});
  ColourImage colour(61, 47);
  for (std::size_t i = 0; i < jpeg.size(); ++i)
    for (const char value : {'\0', '\xff', static_cast<char>(jpeg[i] ^ 0x11)}) {
      std::string altered = jpeg;
      altered[i] = value;
      (void)decode_jpeg(altered, colour);  // under a sanitizer: no access outside the image
    }
  EXPECT_EQ(colour.pixels.size(), std::size_t{61 * 47});
}

}  // namespace
}  // namespace roomradar::jpeg_colour_test
