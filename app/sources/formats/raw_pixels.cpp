// raw_pixels.cpp: checks sizes, then converts row by row (depth) or through OpenCV (colour).
#include "app/sources/formats/raw_pixels.hpp"

#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>

#include "mapping/types/system/error.hpp"

namespace roomradar {
namespace {

constexpr int kMaxSide_px = 16384;

/// Returns the bytes per row, or throws Error if `rows` rows of at least row_bytes do not fit in `bytes`.
std::size_t checked_row_bytes(std::string_view bytes, const RawLayout& layout, std::size_t row_bytes,
                              std::size_t rows, const std::string& where) {
  const std::size_t stride = layout.row_bytes == 0 ? row_bytes : layout.row_bytes;
  if (stride < row_bytes)
    throw Error(where + ": a row of " + std::to_string(layout.width_px) + " pixels does not fit in " +
                std::to_string(stride) + " bytes");
  if (stride > bytes.size() || bytes.size() < (rows - 1) * stride + row_bytes)
    throw Error(where + ": is cut short: an image of " + std::to_string(layout.width_px) + " x " +
                std::to_string(layout.height_px) + " needs more than its " + std::to_string(bytes.size()) +
                " bytes");
  return stride;
}

void require_sides(const RawLayout& layout, const std::string& where) {
  if (layout.width_px < 1 || layout.height_px < 1 || layout.width_px > kMaxSide_px ||
      layout.height_px > kMaxSide_px)
    throw Error(where + ": its size of " + std::to_string(layout.width_px) + " x " +
                std::to_string(layout.height_px) + " is not in 1..16384");
}

}  // namespace

void convert_depth(std::string_view bytes, const RawLayout& layout, DepthPixels pixels, double unit_m,
                   const std::string& where, DepthImage& depth_m) {
  require_sides(layout, where);
  if (!(unit_m > 0.0 && std::isfinite(unit_m))) throw Error(where + ": its unit of depth is not > 0 m");
  const std::size_t pixel_bytes = pixels == DepthPixels::kFloat64   ? 8
                                  : pixels == DepthPixels::kFloat32 ? 4
                                                                    : 2;
  const auto width = static_cast<std::size_t>(layout.width_px);
  const std::size_t stride = checked_row_bytes(bytes, layout, width * pixel_bytes,
                                               static_cast<std::size_t>(layout.height_px), where);
  depth_m.resize(layout.width_px, layout.height_px);
  const double units_per_m = 1.0 / unit_m;
  const bool is_whole = std::abs(units_per_m - std::round(units_per_m)) < 1e-3;
  // Dividing by a whole number gives the float nearest to the depth; multiplying by 0.001F does not.
  const auto divisor = static_cast<float>(is_whole ? std::round(units_per_m) : units_per_m);
  const auto factor = static_cast<float>(unit_m);
  for (int y = 0; y < layout.height_px; ++y) {
    const auto* from =
        reinterpret_cast<const std::uint8_t*>(bytes.data()) + static_cast<std::size_t>(y) * stride;
    float* to = depth_m.row(y);
    for (std::size_t x = 0; x < width; ++x) {
      if (pixels == DepthPixels::kFloat64) {
        double value = 0.0;
        std::memcpy(&value, from + 8 * x, sizeof value);
        const auto depth = static_cast<float>(value * unit_m);
        to[x] = std::isfinite(depth) && depth > 0.0F ? depth : 0.0F;
      } else if (pixels == DepthPixels::kFloat32) {
        float value = 0.0F;
        std::memcpy(&value, from + 4 * x, sizeof value);
        value *= factor;
        to[x] = std::isfinite(value) && value > 0.0F ? value : 0.0F;
      } else {
        const std::uint8_t first = from[2 * x], second = from[2 * x + 1];
        const int units = pixels == DepthPixels::kUint16 ? first | second << 8 : first << 8 | second;
        to[x] = units == 65535 ? 0.0F : static_cast<float>(units) / divisor;
      }
    }
  }
}

void convert_depth(const Image<std::uint16_t>& units, double unit_m, const std::string& where,
                   DepthImage& depth_m) {
  const std::string_view bytes(reinterpret_cast<const char*>(units.pixels.data()), 2 * units.pixels.size());
  convert_depth(bytes, {units.width, units.height}, DepthPixels::kUint16, unit_m, where, depth_m);
}

void convert_inverse_depth(float a, float b, DepthImage& depth_m) {
  for (float& depth : depth_m.pixels) {
    if (depth == 0.0F) continue;
    depth = a / (depth - b);
    if (!(std::isfinite(depth) && depth > 0.0F)) depth = 0.0F;
  }
}

void convert_colour(std::string_view bytes, const RawLayout& layout, ColourPixels pixels,
                    const std::string& where, ColourImage& colour) {
  require_sides(layout, where);
  const auto width = static_cast<std::size_t>(layout.width_px),
             height = static_cast<std::size_t>(layout.height_px);
  const bool is_subsampled =
      pixels == ColourPixels::kYuyv || pixels == ColourPixels::kUyvy || pixels == ColourPixels::kNv12;
  if (is_subsampled && (width % 2 != 0 || (pixels == ColourPixels::kNv12 && height % 2 != 0)))
    throw Error(where + ": is " + std::to_string(width) + " x " + std::to_string(height) +
                "; sides must be even in its encoding");
  struct Conversion {
    int type, code;
    std::size_t bytes_per_pixel;
  };
  const Conversion conversion = [&]() -> Conversion {
    switch (pixels) {
      case ColourPixels::kRgb8:
        return {CV_8UC3, -1, 3};
      case ColourPixels::kBgr8:
        return {CV_8UC3, cv::COLOR_BGR2RGB, 3};
      case ColourPixels::kRgba8:
        return {CV_8UC4, cv::COLOR_RGBA2RGB, 4};
      case ColourPixels::kBgra8:
        return {CV_8UC4, cv::COLOR_BGRA2RGB, 4};
      case ColourPixels::kMono8:
        return {CV_8UC1, cv::COLOR_GRAY2RGB, 1};
      case ColourPixels::kYuyv:
        return {CV_8UC2, cv::COLOR_YUV2RGB_YUYV, 2};
      case ColourPixels::kUyvy:
        return {CV_8UC2, cv::COLOR_YUV2RGB_UYVY, 2};
      case ColourPixels::kNv12:
        return {CV_8UC1, cv::COLOR_YUV2RGB_NV12, 1};
    }
    throw Error(where + ": its encoding is not known");
  }();
  const std::size_t rows = pixels == ColourPixels::kNv12 ? height + height / 2 : height;
  const std::size_t stride =
      checked_row_bytes(bytes, layout, width * conversion.bytes_per_pixel, rows, where);
  colour.resize(layout.width_px, layout.height_px);
  const cv::Mat from(static_cast<int>(rows), layout.width_px, conversion.type,
                     const_cast<char*>(bytes.data()), stride);
  cv::Mat to(layout.height_px, layout.width_px, CV_8UC3, colour.pixels.data());
  if (conversion.code < 0)
    from.copyTo(to);
  else
    cv::cvtColor(from, to, conversion.code);
}

}  // namespace roomradar
