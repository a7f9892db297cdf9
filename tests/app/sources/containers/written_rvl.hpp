// written_rvl.hpp: encodes depth as RTAB-Map and ROS do.
// Source: RTAB-Map, corelib/src/rvl_codec.cpp, RvlCodec::CompressRVL() and EncodeVLE(); corelib/src/
// Compression.cpp, compressImage(). ROS, image_transport_plugins,
// compressed_depth_image_transport/src/codec.cpp, encodeCompressedDepthImage().
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "mapping/types/image.hpp"

namespace roomradar::test {

inline std::string little_endian(std::uint32_t number) {
  return {reinterpret_cast<const char*>(&number), sizeof number};
}

/// Returns columns, rows and the stream: what follows the signature DEPTHRVL or the header of
/// compressedDepth.
inline std::string written_rvl(const Image<std::uint16_t>& image) {
  std::vector<std::uint32_t> groups;
  const auto write = [&](std::uint32_t value) {
    do {
      const std::uint32_t group = value & 7U;
      value >>= 3U;
      groups.push_back(value != 0 ? group | 8U : group);
    } while (value != 0);
  };
  std::int32_t previous = 0;
  const std::vector<std::uint16_t>& pixels = image.pixels;
  for (std::size_t at = 0; at < pixels.size();) {
    std::size_t end = at;
    while (end < pixels.size() && pixels[end] == 0) ++end;
    write(static_cast<std::uint32_t>(end - at));
    at = end;
    while (end < pixels.size() && pixels[end] != 0) ++end;
    write(static_cast<std::uint32_t>(end - at));
    for (; at < end; ++at) {
      const std::int32_t difference = pixels[at] - previous;
      write(static_cast<std::uint32_t>((difference * 2) ^ (difference >> 31)));
      previous = pixels[at];
    }
  }
  while (groups.size() % 8 != 0) groups.push_back(0);
  std::string bytes = little_endian(static_cast<std::uint32_t>(image.width)) +
                      little_endian(static_cast<std::uint32_t>(image.height));
  for (std::size_t i = 0; i < groups.size(); i += 8) {
    std::uint32_t word = 0;
    for (std::size_t k = i; k < i + 8; ++k) word = word << 4U | groups[k];
    bytes += little_endian(word);
  }
  return bytes;
}

}  // namespace roomradar::test
