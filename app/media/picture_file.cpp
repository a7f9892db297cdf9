// picture_file.cpp: encodes PNG files in memory, then writes them atomically.
#include "app/media/picture_file.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "mapping/types/system/atomic_file.hpp"
#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

void write_encoded(const cv::Mat& image, const std::filesystem::path& path) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 3}))
    throw Error(path.string() + ": the picture cannot be encoded as PNG");
  AtomicFile file(path);
  file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                      static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

template <typename Pixel>
void require_pixels(const Image<Pixel>& image, const std::filesystem::path& path) {
  if (image.empty()) throw Error(path.string() + ": the image to be written is empty");
}

/// Wraps the image's pixels for OpenCV, which only reads them.
template <typename Pixel>
cv::Mat view_of(const Image<Pixel>& image, int type) {
  return {image.height, image.width, type, const_cast<Pixel*>(image.pixels.data())};
}

}  // namespace

void require_png_name(const std::filesystem::path& path) {
  if (!path.empty() && path.extension() != ".png")
    throw Error(path.string() + ": is no name for a PNG picture; give one that ends in .png");
}

void write_png(const ColourImage& picture, const std::filesystem::path& path) {
  require_pixels(picture, path);
  cv::Mat bgr;
  cv::cvtColor(view_of(picture, CV_8UC3), bgr, cv::COLOR_RGB2BGR);
  write_encoded(bgr, path);
}

void write_png(const MaskImage& mask, const std::filesystem::path& path) {
  require_pixels(mask, path);
  write_encoded(view_of(mask, CV_8UC1), path);
}

}  // namespace roomradar
