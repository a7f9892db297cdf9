// picture_file.cpp: images to PNG files, encoded in memory and then written whole.
#include "app/picture_file.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "mapping/types/error.hpp"

namespace roomradar {
namespace {

void write_encoded(const cv::Mat& image, const std::filesystem::path& path) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 3}))
    throw Error(path.string() + ": the picture cannot be encoded as PNG");
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) throw Error(path.string() + ": cannot be made; does its folder exist, and may it be written?");
  file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw Error(path.string() + ": cannot be written whole; is the disk full?");
}

template <typename Pixel>
void require_pixels(const Image<Pixel>& image, const std::filesystem::path& path) {
  if (image.empty()) throw Error(path.string() + ": the image to be written is empty");
}

/// The image's pixels seen by OpenCV, which only reads them.
template <typename Pixel>
cv::Mat view_of(const Image<Pixel>& image, int type) {
  return {image.height, image.width, type, const_cast<Pixel*>(image.pixels.data())};
}

}  // namespace

void write_png(const ColourImage& picture, const std::filesystem::path& path) {
  require_pixels(picture, path);
  cv::Mat bgr;
  cv::cvtColor(view_of(picture, CV_8UC3), bgr, cv::COLOR_RGB2BGR);
  write_encoded(bgr, path);
}

void write_png(const DepthImage& depth_m, const std::filesystem::path& path, float near_m, float far_m) {
  require_pixels(depth_m, path);
  if (!(far_m > near_m)) {
    std::vector<float> measured;
    std::copy_if(depth_m.pixels.begin(), depth_m.pixels.end(), std::back_inserter(measured),
                 [](float z) { return z > 0.0F && std::isfinite(z); });
    if (measured.empty()) measured = {0.0F};
    const auto percentile = [&](double part) {
      const auto nth =
          measured.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(measured.size() - 1));
      std::nth_element(measured.begin(), nth, measured.end());
      return *nth;
    };
    near_m = percentile(0.01);
    far_m = std::max(percentile(0.99), near_m + 1e-3F);
  }
  cv::Mat1b nearness(depth_m.height, depth_m.width);
  for (int y = 0; y < depth_m.height; ++y) {
    for (int x = 0; x < depth_m.width; ++x) {
      const float part = std::clamp((depth_m.at(x, y) - near_m) / (far_m - near_m), 0.0F, 1.0F);
      nearness(y, x) = static_cast<unsigned char>(std::lround(255.0F * (1.0F - part)));
    }
  }
  cv::Mat bgr;
  cv::applyColorMap(nearness, bgr, cv::COLORMAP_TURBO);
  for (int y = 0; y < depth_m.height; ++y)
    for (int x = 0; x < depth_m.width; ++x)
      if (!(depth_m.at(x, y) > 0.0F)) bgr.at<cv::Vec3b>(y, x) = {0, 0, 0};
  write_encoded(bgr, path);
}

void write_png(const MaskImage& mask, const std::filesystem::path& path) {
  require_pixels(mask, path);
  write_encoded(view_of(mask, CV_8UC1), path);
}

}  // namespace roomradar
