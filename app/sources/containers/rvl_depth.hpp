// rvl_depth.hpp: 16 bit depth in run lengths and differences (RVL), as RTAB-Map and ROS store it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "mapping/types/image.hpp"

namespace roomradar {

/// Bytes of the size before the stream: columns and rows, 32 bit each.
inline constexpr std::size_t kRvlSize_bytes = 8;

struct RvlSize {
  int width_px = 0;
  int height_px = 0;
  friend bool operator==(const RvlSize&, const RvlSize&) = default;
};

/// Reads the size of an image without decoding it. Throws Error naming `where` if `bytes` are shorter than
/// the size, a side is outside 1..16384 px, or the image has more than 4096 x 4096 pixels and more than 1024
/// for each byte of the stream. The last limit rejects a damaged size before memory is allocated; an image
/// without any measurement takes 8 bytes and is valid.
[[nodiscard]] RvlSize read_rvl_size(std::string_view bytes, const std::string& where);

/// Decodes an image in the unit of its device: columns and rows (32 bit little-endian), then the stream of
/// Wilson, Fast Lossless Depth Image Compression, SIGCHI 2017. Bytes after the last pixel are ignored.
/// @param bytes  from the columns onwards, without signature or header
/// @param expected  size of the recording's images; {}: not known yet
/// @param units     0: no measurement. Keeps its allocation if that is large enough.
/// @throws Error as read_rvl_size() does, and if the size is not the expected one, the stream ends too early,
///         or a run or a pixel is impossible
/// Source: RTAB-Map, corelib/src/rvl_codec.cpp, RvlCodec::DecompressRVL(); the same code is in ROS,
/// image_transport_plugins, compressed_depth_image_transport/src/rvl_codec.cpp.
void decode_rvl(std::string_view bytes, RvlSize expected, const std::string& where,
                Image<std::uint16_t>& units);

}  // namespace roomradar
