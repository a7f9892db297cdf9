// raw_pixels.hpp: converts uncompressed pixels of devices to depth and colour images.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "mapping/types/image.hpp"

namespace roomradar {

enum class DepthPixels {
  kUint16,           ///< little-endian; 0 and 65535: no measurement
  kUint16BigEndian,  ///< as kUint16, big-endian
  kFloat32,          ///< little-endian; not finite or <= 0: no measurement
  kFloat64,          ///< as kFloat32
};

enum class ColourPixels { kRgb8, kBgr8, kRgba8, kBgra8, kMono8, kYuyv, kUyvy, kNv12 };

/// Layout of uncompressed pixels.
struct RawLayout {
  int width_px = 0;
  int height_px = 0;
  std::size_t row_bytes = 0;  ///< row stride in bytes; 0: rows without padding
};

/// Converts depth. `unit_m` is the length of one unit, m.
/// @throws Error naming `where` if a side is outside 1..16384 px, unit_m is not > 0, or `bytes` is shorter
///         than the layout requires
void convert_depth(std::string_view bytes, const RawLayout& layout, DepthPixels pixels, double unit_m,
                   const std::string& where, DepthImage& depth_m);

/// Converts depth of 16 bit. Throws Error as convert_depth() above does.
void convert_depth(const Image<std::uint16_t>& units, double unit_m, const std::string& where,
                   DepthImage& depth_m);

/// Converts quantised inverse depth in place: each pixel, 1..65535 or 0, becomes a / (pixel - b), m. Results
/// that are not finite or <= 0 become 0. Source: ROS, image_transport_plugins,
/// compressed_depth_image_transport/src/codec.cpp, decodeCompressedDepthImage().
void convert_inverse_depth(float a, float b, DepthImage& depth_m);

/// Converts colour. Throws Error as convert_depth() does. kYuyv, kUyvy and kNv12 need an even width, kNv12
/// also an even height.
void convert_colour(std::string_view bytes, const RawLayout& layout, ColourPixels pixels,
                    const std::string& where, ColourImage& colour);

}  // namespace roomradar
