// jpeg.cpp: encodes and decodes through OpenCV, after a look at the header.
#include "mapping/texture/jpeg.hpp"

#include <cstddef>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "mapping/types/system/error.hpp"

namespace roomradar {

std::vector<std::uint8_t> jpeg_of(const ColourImage& picture, int quality) {
  const cv::Mat rgb(picture.height, picture.width, CV_8UC3,
                    const_cast<Rgb*>(picture.pixels.data()));  // read only
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<std::uint8_t> jpeg;
  if (picture.empty() ||
      !cv::imencode(".jpg", bgr, jpeg, {cv::IMWRITE_JPEG_QUALITY, quality, cv::IMWRITE_JPEG_OPTIMIZE, 1}))
    throw Error("a picture of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
                " pixels cannot be written as JPEG");
  return jpeg;
}

void require_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px, const std::string& where) {
  const auto byte = [&](std::size_t i) { return i < jpeg.size() ? jpeg[i] : 0; };
  const auto word = [&](std::size_t i) { return 256 * byte(i) + byte(i + 1); };
  const std::size_t size = jpeg.size();
  if (size < 4 || word(0) != 0xffd8) throw Error(where + ": is no JPEG picture");
  if (word(size - 2) != 0xffd9) throw Error(where + ": is cut short; a JPEG picture ends otherwise");
  // Segments: a marker, then the length of the rest. Start of frame: precision, height, width.
  for (std::size_t at = 2; at + 9 < size && byte(at) == 0xff;
       at += 2 + static_cast<std::size_t>(word(at + 2))) {
    const int marker = byte(at + 1);
    const bool is_frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (!is_frame) continue;
    const int height = word(at + 5), width = word(at + 7);
    if (width != width_px || height != height_px)
      throw Error(where + ": has " + std::to_string(width) + " x " + std::to_string(height) +
                  " pixels, and " + std::to_string(width_px) + " x " + std::to_string(height_px) +
                  " belong to the map");
    return;
  }
  throw Error(where + ": is a damaged JPEG picture without a size");
}

ColourImage picture_of_jpeg(std::span<const std::uint8_t> jpeg, int width_px, int height_px,
                            const std::string& where) {
  require_jpeg(jpeg, width_px, height_px, where);
  cv::Mat decoded;
  try {
    const cv::Mat bytes(1, static_cast<int>(jpeg.size()), CV_8UC1,
                        const_cast<std::uint8_t*>(jpeg.data()));  // read only
    decoded = cv::imdecode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    decoded.release();
  }
  if (decoded.cols != width_px || decoded.rows != height_px)
    throw Error(where + ": cannot be decoded; is it damaged?");
  ColourImage picture(width_px, height_px);
  cv::Mat rgb(height_px, width_px, CV_8UC3, picture.pixels.data());
  cv::cvtColor(decoded, rgb, cv::COLOR_BGR2RGB);
  return picture;
}

}  // namespace roomradar
