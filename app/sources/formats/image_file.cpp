// image_file.cpp: image files through OpenCV's codecs, with checks before and after.
#include "app/sources/formats/image_file.hpp"

#include <bit>
#include <cmath>
#include <cstring>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "app/sources/formats/image_header.hpp"
#include "app/sources/formats/jpeg_colour.hpp"
#include "app/sources/formats/kinect_units.hpp"
#include "mapping/types/system/error.hpp"
#include "mapping/types/system/file_io.hpp"

namespace roomradar {
namespace {

constexpr std::uintmax_t kLargestImage_bytes = std::uintmax_t{1} << 30;

std::string read_image_bytes(const std::filesystem::path& path) {
  return read_bytes(path, "an image", kLargestImage_bytes);
}

void write_png(const cv::Mat& image, const std::filesystem::path& path) {
  std::vector<std::uint8_t> bytes;
  // OpenCV's default compression is its fastest: any explicit level enables slower filters (14 instead of 7
  // ms).
  if (!cv::imencode(".png", image, bytes)) throw Error(path.string() + ": cannot be encoded as PNG");
  write_bytes(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// Decodes to `type` (an OpenCV type) and checks the size against the header.
cv::Mat decode(std::string_view bytes, int flags, int type, const ImageHeader& header,
               const std::string& name) {
  cv::Mat image;
  try {
    image = cv::imdecode(cv::Mat(1, static_cast<int>(bytes.size()), CV_8UC1, const_cast<char*>(bytes.data())),
                         flags);
  } catch (const cv::Exception& fault) {
    throw Error(name + ": cannot be decoded: " + fault.err);
  }
  if (image.empty() || image.type() != type || image.cols != header.width_px ||
      image.rows != header.height_px)
    throw Error(name + ": is damaged: its pixels cannot be decoded");
  return image;
}

cv::Mat decode_16_bit_png(std::string_view bytes, const std::string& name) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind != ImageKind::kPng || header.bits != 16 || header.channels != 1)
    throw Error(name + ": is a " + to_string(header) + "; depth must be a 16 bit grey PNG");
  return decode(bytes, cv::IMREAD_UNCHANGED, CV_16UC1, header, name);
}

/// Converts units to m; `invalid` is no measurement.
void convert(const cv::Mat& image, float units_per_m, int invalid, DepthImage& depth_m) {
  depth_m.resize(image.cols, image.rows);
  for (int y = 0; y < image.rows; ++y) {
    const std::uint16_t* from = image.ptr<std::uint16_t>(y);
    float* to = depth_m.row(y);
    for (int x = 0; x < image.cols; ++x) {  // vectorised, since it always divides
      const float depth = static_cast<float>(from[x]) / units_per_m;
      to[x] = from[x] == invalid ? 0.0F : depth;
    }
  }
}

void read_kinect_raw(const std::filesystem::path& path, DepthImage& depth_m) {
  const std::string name = path.string();
  const std::string bytes = read_image_bytes(path);
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind != ImageKind::kPgm || header.bits != 16)
    throw Error(name + ": is a " + to_string(header) + "; raw Kinect depth must be a 16 bit PGM");
  depth_m.resize(header.width_px, header.height_px);
  const std::uint8_t* raw = reinterpret_cast<const std::uint8_t*>(bytes.data()) + header.pixels_at;
  for (float& pixel : depth_m.pixels) {
    pixel = raw_depth_m(static_cast<std::uint16_t>(raw[0] | raw[1] << 8));
    raw += 2;
  }
}

/// Wraps the image's pixels as RGB, without copying.
cv::Mat view_of(ColourImage& image) {
  static_assert(sizeof(Rgb) == 3);
  return {image.height, image.width, CV_8UC3, image.pixels.data()};
}

}  // namespace

void read_depth_file(const std::filesystem::path& path, DepthEncoding encoding, DepthImage& depth_m) {
  if (encoding == DepthEncoding::kKinectRaw) return read_kinect_raw(path, depth_m);
  const cv::Mat image = decode_16_bit_png(read_image_bytes(path), path.string());
  const bool is_tum = encoding == DepthEncoding::kTum;
  convert(image, is_tum ? 5000.0F : 1000.0F, is_tum ? 0 : 65535, depth_m);
}

void decode_depth_png(std::string_view bytes, float units_per_m, const std::string& name,
                      DepthImage& depth_m) {
  convert(decode_16_bit_png(bytes, name), units_per_m, 65535, depth_m);
}

void decode_float_png(std::string_view bytes, const std::string& name, DepthImage& depth_m) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind != ImageKind::kPng || header.bits != 8 || header.channels != 4)
    throw Error(name + ": is a " + to_string(header) + "; must be a PNG of four 8 bit channels");
  const cv::Mat image = decode(bytes, cv::IMREAD_UNCHANGED, CV_8UC4, header, name);
  depth_m.resize(image.cols, image.rows);
  for (int y = 0; y < image.rows; ++y)
    std::memcpy(depth_m.row(y), image.ptr(y), static_cast<std::size_t>(image.cols) * sizeof(float));
  for (float& depth : depth_m.pixels)
    if (!(std::isfinite(depth) && depth > 0.0F)) depth = 0.0F;
}

void decode_grey_png(std::string_view bytes, const std::string& name, Image<std::uint8_t>& image) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind != ImageKind::kPng || header.bits != 8 || header.channels != 1)
    throw Error(name + ": is a " + to_string(header) + "; must be an 8 bit grey PNG");
  const cv::Mat grey = decode(bytes, cv::IMREAD_UNCHANGED, CV_8UC1, header, name);
  image.resize(header.width_px, header.height_px);
  for (int y = 0; y < grey.rows; ++y)
    std::memcpy(image.row(y), grey.ptr(y), static_cast<std::size_t>(grey.cols));
}

void read_colour_file(const std::filesystem::path& path, ColourImage& colour) {
  decode_colour(read_image_bytes(path), path.string(), colour);
}

void decode_colour(std::string_view bytes, const std::string& name, ColourImage& colour) {
  const ImageHeader header = read_image_header(bytes, name);
  if (header.kind == ImageKind::kPpm && header.bits == 8) {
    colour.resize(header.width_px, header.height_px);
    std::memcpy(colour.pixels.data(), bytes.data() + header.pixels_at, colour.pixels.size() * sizeof(Rgb));
    return;
  }
  if (header.kind == ImageKind::kJpeg && header.bits == 8 && (header.channels == 1 || header.channels == 3)) {
    if (colour.width != header.width_px || colour.height != header.height_px)
      colour.resize(header.width_px, header.height_px);
    if (const auto fault = decode_jpeg(bytes, colour)) throw Error(name + ": cannot be decoded: " + *fault);
    return;
  }
  const cv::Mat image =
      decode(bytes, cv::IMREAD_COLOR | cv::IMREAD_IGNORE_ORIENTATION, CV_8UC3, header, name);
  colour.resize(header.width_px, header.height_px);
  cv::Mat red_first = view_of(colour);
  cv::cvtColor(image, red_first, cv::COLOR_BGR2RGB);
}

void write_depth_file(const DepthImage& depth_m, DepthEncoding encoding, const std::filesystem::path& path) {
  cv::Mat image(depth_m.height, depth_m.width, CV_16UC1);
  const bool is_raw = encoding == DepthEncoding::kKinectRaw;
  const float units_per_m = encoding == DepthEncoding::kTum ? 5000.0F : 1000.0F;
  const float largest = encoding == DepthEncoding::kTum ? 65535.0F : 65534.0F;  // 65535 mm means invalid
  for (int y = 0; y < depth_m.height; ++y) {
    const float* from = depth_m.row(y);
    std::uint16_t* to = image.ptr<std::uint16_t>(y);
    for (int x = 0; x < depth_m.width; ++x) {
      const float units = std::round(from[x] * units_per_m);
      to[x] = is_raw                             ? raw_from_depth_m(from[x])
              : units > 0.0F && units <= largest ? static_cast<std::uint16_t>(units)
                                                 : std::uint16_t{0};
    }
  }
  if (!is_raw) return write_png(image, path);
  static_assert(std::endian::native == std::endian::little, "raw Kinect depth is little-endian on disk");
  std::string bytes = "P5 " + std::to_string(image.cols) + " " + std::to_string(image.rows) + " 65535\n";
  bytes.append(reinterpret_cast<const char*>(image.data), image.total() * image.elemSize());
  write_bytes(path, bytes);
}

void write_colour_file(const ColourImage& colour, const std::filesystem::path& path) {
  if (path.extension() == ".ppm") {
    std::string bytes = "P6 " + std::to_string(colour.width) + " " + std::to_string(colour.height) + " 255\n";
    bytes.append(reinterpret_cast<const char*>(colour.pixels.data()), colour.pixels.size() * sizeof(Rgb));
    return write_bytes(path, bytes);
  }
  const cv::Mat red_first(colour.height, colour.width, CV_8UC3, const_cast<Rgb*>(colour.pixels.data()));
  cv::Mat blue_first;
  cv::cvtColor(red_first, blue_first, cv::COLOR_RGB2BGR);
  write_png(blue_first, path);
}

void write_mask_file(const MaskImage& mask, const std::filesystem::path& path) {
  write_png({mask.height, mask.width, CV_8UC1, const_cast<std::uint8_t*>(mask.pixels.data())}, path);
}

void write_exact_depth_file(const DepthImage& depth_m, const std::filesystem::path& path) {
  cv::Mat halves(2 * depth_m.height, depth_m.width, CV_16UC1);
  for (int y = 0; y < depth_m.height; ++y)
    for (int x = 0; x < depth_m.width; ++x) {
      const auto bits = std::bit_cast<std::uint32_t>(depth_m.at(x, y));
      halves.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(bits >> 16);
      halves.at<std::uint16_t>(y + depth_m.height, x) = static_cast<std::uint16_t>(bits & 0xffff);
    }
  write_png(halves, path);
}

void read_exact_depth_file(const std::filesystem::path& path, DepthImage& depth_m) {
  const cv::Mat halves = decode_16_bit_png(read_image_bytes(path), path.string());
  depth_m.resize(halves.cols, halves.rows / 2);
  for (int y = 0; y < depth_m.height; ++y)
    for (int x = 0; x < depth_m.width; ++x) {
      float& depth = depth_m.at(x, y);
      depth = std::bit_cast<float>(static_cast<std::uint32_t>(halves.at<std::uint16_t>(y, x)) << 16 |
                                   halves.at<std::uint16_t>(y + depth_m.height, x));
      if (!(depth >= 0.0F && std::isfinite(depth)))
        throw Error(path.string() + ": is damaged: a pixel holds " + std::to_string(depth) + " m");
    }
}

}  // namespace roomradar
